// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "parkade/geometry/se2.hpp"

namespace parkade {

/// Where the car has been: a place every metre, each with its anchor. World frame, m.
class DrivenWay {
 public:
  void add(const Eigen::Vector2d& p, std::int64_t anchor);
  /// As SlotRegistry's.
  void moveWithAnchors(const std::function<SE2(std::int64_t)>& correction);
  /// Whether the car came as near to p as `reach` metres.
  [[nodiscard]] bool passed(const Eigen::Vector2d& p, double reach) const;

 private:
  struct Place {
    Eigen::Vector2d p;
    std::int64_t anchor = 0;
  };
  std::vector<Place> places_;
};

}  // namespace parkade
