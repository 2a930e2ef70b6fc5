// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/bay_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace parkade::slot_registry {
namespace {

// "B07" is no such number, for nobody knows whether "B10" or "B010" is three further.
struct Counter {
  std::string prefix;
  int value = 0;
  auto operator<=>(const Counter&) const = default;
  [[nodiscard]] std::string text() const { return prefix + std::to_string(value); }
};

std::optional<Counter> counterOf(const std::string& text) {
  const std::size_t digits = text.find_last_not_of("0123456789") + 1;  // npos + 1 is 0
  constexpr std::size_t kMostDigits = 5;
  if (digits == text.size() || text.size() - digits > kMostDigits || text[digits] == '0')
    return std::nullopt;
  Counter counter;
  counter.prefix = text.substr(0, digits);
  std::from_chars(text.data() + digits, text.data() + text.size(), counter.value);
  return counter;
}

using Bay = std::vector<std::size_t>;  // indices, from left to right for who drives in

// Chains of slots of which each begins where the one before ends.
std::vector<Bay> findBays(const std::vector<MapSlot>& slots) {
  constexpr double kTouch = 0.35;       // m
  constexpr double kParallel = 0.9848;  // cosine of 10 degrees
  const auto frontOf = [](const MapSlot& slot) {
    return Eigen::Vector2d((slot.corners[1] - slot.corners[0]).normalized());
  };
  std::vector<std::optional<std::size_t>> next(slots.size());
  std::vector<bool> begins(slots.size(), true);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    for (std::size_t j = 0; j < slots.size(); ++j) {
      if (i == j || !begins[j] || (slots[j].corners[0] - slots[i].corners[1]).norm() > kTouch ||
          frontOf(slots[i]).dot(frontOf(slots[j])) < kParallel) {
        continue;
      }
      next[i] = j;
      begins[j] = false;
      break;
    }
  }
  std::vector<Bay> bays;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!begins[i]) continue;
    Bay bay;
    for (std::optional<std::size_t> at = i; at; at = next[*at]) bay.push_back(*at);
    bays.push_back(std::move(bay));
  }
  return bays;
}

// 1 or -1 from left to right; 0 where the readings do not tell.
int findDirection(const std::vector<Bay>& bays,
                  const std::vector<std::optional<Counter>>& counters) {
  constexpr int kLeast = 3;
  constexpr int kClearly = 4;
  int up = 0;
  int down = 0;
  for (const Bay& bay : bays) {
    for (std::size_t k = 1; k < bay.size(); ++k) {
      const std::optional<Counter>& a = counters[bay[k - 1]];
      const std::optional<Counter>& b = counters[bay[k]];
      if (!a || !b || a->prefix != b->prefix) continue;
      if (b->value == a->value + 1) ++up;
      if (b->value == a->value - 1) ++down;
    }
  }
  if (std::max(up, down) < kLeast || std::max(up, down) < kClearly * std::min(up, down)) return 0;
  return up > down ? 1 : -1;
}

// Readings, and which of them a neighbour's confirms.
struct Readings {
  std::vector<std::optional<Counter>> counters;
  std::vector<bool> are_sure;
};

// The number of the first slot of a bay by the reading of its k-th.
Counter firstBy(const Counter& reading, int direction, std::size_t k) {
  Counter first = reading;
  first.value -= direction * static_cast<int>(k);
  return first;
}

void findSure(const Bay& bay, int direction, Readings& readings) {
  for (std::size_t k = 1; k < bay.size(); ++k) {
    const std::optional<Counter>& a = readings.counters[bay[k - 1]];
    const std::optional<Counter>& b = readings.counters[bay[k]];
    if (!a || !b || firstBy(*b, direction, 1) != *a) continue;
    readings.are_sure[bay[k - 1]] = readings.are_sure[bay[k]] = true;
  }
}

// The parts of a bay whose sure readings agree: all of it, or from each run of those that do to the
// next, without what lies between two.
std::vector<Bay> partsOf(const Bay& bay, int direction, const Readings& readings) {
  std::vector<Bay> parts;
  std::optional<Counter> first;  // of the bay, by the newest sure reading
  std::size_t begin = 0;         // of the newest part
  std::size_t last = 0;          // the newest sure reading
  for (std::size_t k = 0; k < bay.size(); ++k) {
    if (!readings.are_sure[bay[k]]) continue;
    const Counter by_this = firstBy(*readings.counters[bay[k]], direction, k);
    if (first && *first != by_this) {
      parts.emplace_back(bay.begin() + static_cast<std::ptrdiff_t>(begin),
                         bay.begin() + static_cast<std::ptrdiff_t>(last + 1));
      begin = k;
    }
    first = by_this;
    last = k;
  }
  parts.emplace_back(bay.begin() + static_cast<std::ptrdiff_t>(begin), bay.end());
  return parts;
}

struct Numbering {
  const Bay* part = nullptr;
  Counter first;
  double support = 0.0;
};

// None where the readings of a part of a bay do not agree, or sure ones are outvoted.
std::optional<Numbering> numberingOf(const Bay& part, int direction, const Readings& readings,
                                     const std::vector<double>& support) {
  constexpr double kClearly = 2.0;
  std::map<Counter, double> votes;
  std::optional<Counter> sure;
  for (std::size_t k = 0; k < part.size(); ++k) {
    if (!readings.counters[part[k]]) continue;
    const Counter first = firstBy(*readings.counters[part[k]], direction, k);
    votes[first] += support[part[k]];
    if (readings.are_sure[part[k]]) sure = first;
  }
  double all = 0.0;
  Numbering best;
  best.part = &part;
  for (const auto& [first, vote] : votes) {
    all += vote;
    if (vote <= best.support) continue;
    best.support = vote;
    best.first = first;
  }
  const int last = best.first.value + direction * (static_cast<int>(part.size()) - 1);
  if (votes.empty() || best.support < kClearly * (all - best.support) ||
      std::min(best.first.value, last) < 1 || (sure && *sure != best.first)) {
    return std::nullopt;
  }
  return best;
}

// The likeliest first; what a numbering gives to a slot no other may have.
void giveNumbers(const std::vector<Numbering>& numberings, int direction, const Readings& readings,
                 std::vector<MapSlot>& slots) {
  std::map<Counter, std::size_t> sure;  // whose they are
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (readings.are_sure[i]) sure.try_emplace(*readings.counters[i], i);
  }
  std::set<Counter> taken;
  std::vector<bool> is_done(slots.size(), false);
  for (const Numbering& numbering : numberings) {
    std::vector<Counter> numbers(numbering.part->size(), numbering.first);
    for (std::size_t k = 0; k < numbers.size(); ++k)
      numbers[k].value += direction * static_cast<int>(k);
    if (std::any_of(numbers.begin(), numbers.end(),
                    [&](const Counter& number) { return taken.count(number) > 0; })) {
      continue;
    }
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const std::size_t slot = (*numbering.part)[k];
      const auto elsewhere = sure.find(numbers[k]);
      if (elsewhere != sure.end() && elsewhere->second != slot) continue;
      slots[slot].number = numbers[k].text();
      is_done[slot] = true;
      taken.insert(numbers[k]);
    }
  }
  // What was read elsewhere and is another slot's by now was misread.
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!is_done[i] && !readings.are_sure[i] && readings.counters[i] &&
        taken.count(*readings.counters[i]) > 0) {
      slots[i].number.clear();
    }
  }
}

}  // namespace

void numberBays(std::vector<MapSlot>& slots, const std::vector<double>& support) {
  Readings readings;
  for (const MapSlot& slot : slots) readings.counters.push_back(counterOf(slot.number));
  readings.are_sure.assign(slots.size(), false);
  const std::vector<Bay> bays = findBays(slots);
  const int direction = findDirection(bays, readings.counters);
  if (direction == 0) return;
  std::vector<Bay> parts;
  for (const Bay& bay : bays) {
    findSure(bay, direction, readings);
    for (Bay& part : partsOf(bay, direction, readings)) parts.push_back(std::move(part));
  }
  std::vector<Numbering> numberings;
  for (const Bay& part : parts) {
    if (const auto numbering = numberingOf(part, direction, readings, support))
      numberings.push_back(*numbering);
  }
  std::stable_sort(numberings.begin(), numberings.end(),
                   [](const Numbering& a, const Numbering& b) { return a.support > b.support; });
  giveNumbers(numberings, direction, readings, slots);
}

}  // namespace parkade::slot_registry
