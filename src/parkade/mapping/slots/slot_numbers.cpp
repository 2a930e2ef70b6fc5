// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/slot_numbers.hpp"

#include <algorithm>
#include <map>

#include "parkade/geometry/planar.hpp"

namespace parkade::slot_registry {

SlotNumbers::SlotNumbers(int min_readings, double min_probability)
    : min_readings_(min_readings), min_probability_(min_probability) {}

void SlotNumbers::add(const std::vector<TextReading>& readings, const Eigen::Vector2d& p,
                      std::int64_t anchor) {
  constexpr double kApart = 0.6;  // m
  auto near = std::find_if(numbers_.begin(), numbers_.end(),
                           [&](const Number& number) { return (number.p - p).norm() < kApart; });
  if (near == numbers_.end()) near = numbers_.insert(near, Number{p, anchor});
  ++near->readings;
  near->p += (p - near->p) / near->readings;
  near->text.add(readings);
}

void SlotNumbers::moveWithAnchors(const std::function<SE2(std::int64_t)>& correction) {
  for (Number& number : numbers_) number.p = correction(number.anchor) * number.p;
}

std::optional<SlotNumber> SlotNumbers::within(const std::array<Eigen::Vector2d, 4>& corners) const {
  TextEvidence text;
  int readings = 0;
  for (const Number& number : numbers_) {
    if (!contains(corners, number.p)) continue;
    text.add(number.text);
    readings += number.readings;
  }
  if (readings < min_readings_) return std::nullopt;
  const TextReading best = text.best();
  if (best.text.empty() || best.probability < min_probability_) return std::nullopt;
  return SlotNumber{best.text, text.support(best.text)};
}

void keepSurestNumbers(std::vector<std::optional<SlotNumber>>& numbers) {
  std::map<std::string, std::size_t> surest;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!numbers[i]) continue;
    const auto [it, first] = surest.try_emplace(numbers[i]->text, i);
    if (first) continue;
    const bool better = numbers[i]->support > numbers[it->second]->support;
    numbers[better ? it->second : i].reset();
    if (better) it->second = i;
  }
}

}  // namespace parkade::slot_registry
