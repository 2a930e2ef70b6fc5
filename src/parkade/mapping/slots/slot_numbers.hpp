// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "parkade/geometry/se2.hpp"
#include "parkade/types/text_evidence.hpp"

namespace parkade::slot_registry {

/// A painted number as read within a slot's area.
struct SlotNumber {
  std::string text;
  double support = 0.0;  ///< what speaks for it, in readings
};

/// Numbers read on the floor, each at its place, whatever slot it turns out to lie in. World frame.
class SlotNumbers {
 public:
  /// min_readings: numbers read less often are not told; min_probability: nor less surely.
  SlotNumbers(int min_readings, double min_probability);

  /// One look's readings at p, best first; anchor: the pose that a new number hangs on.
  void add(const std::vector<TextReading>& readings, const Eigen::Vector2d& p, std::int64_t anchor);
  /// Moves every number with its anchor. correction(anchor): T_new_old.
  void moveWithAnchors(const std::function<SE2(std::int64_t)>& correction);
  /// The number that a slot's area bears, where it is sure.
  [[nodiscard]] std::optional<SlotNumber> within(
      const std::array<Eigen::Vector2d, 4>& corners) const;

 private:
  struct Number {
    Eigen::Vector2d p;
    std::int64_t anchor;
    int readings = 0;
    TextEvidence text = {};
  };
  int min_readings_;
  double min_probability_;
  std::vector<Number> numbers_;
};

/// Of slots that bear one number, the one where it was read most surely keeps it: elsewhere it was
/// misread.
void keepSurestNumbers(std::vector<std::optional<SlotNumber>>& numbers);

}  // namespace parkade::slot_registry
