// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "parkade/geometry/se2.hpp"

namespace parkade {

/// The car's origin moved straight from one place to the next. World frame, m.
struct DrivenStep {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

/// Where the car has been: places at least a step apart, each with its anchor. World frame, m.
class DrivenWay {
 public:
  explicit DrivenWay(double step_m) : step_m_(step_m) {}

  void add(const Eigen::Vector2d& p, std::int64_t anchor);
  /// As SlotRegistry's.
  void moveWithAnchors(const std::function<SE2(std::int64_t)>& correction);
  /// Whether the car came as near to p as `reach` metres.
  [[nodiscard]] bool passed(const Eigen::Vector2d& p, double reach) const;
  /// From each place to the next, but for those further apart than a car's way is straight (3 m):
  /// nobody knows how it got from one to the other.
  [[nodiscard]] std::vector<DrivenStep> steps() const;

 private:
  struct Place {
    Eigen::Vector2d p;
    std::int64_t anchor = 0;
  };
  double step_m_ = 1.0;
  std::vector<Place> places_;
};

}  // namespace parkade
