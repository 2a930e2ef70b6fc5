// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <vector>

#include "parkade/sim/world/car_mesh.hpp"

namespace parkade::sim {

/// A curve over the share of the length (0 at the nose, 1 at the tail), through given points.
class Curve {
 public:
  Curve(std::initializer_list<Eigen::Vector2f> points) : points_(points) {}
  [[nodiscard]] float operator()(float s) const {
    if (s <= points_.front().x()) return points_.front().y();
    for (std::size_t i = 1; i < points_.size(); ++i) {
      if (s > points_[i].x()) continue;
      const Eigen::Vector2f& a = points_[i - 1];
      const Eigen::Vector2f& b = points_[i];
      return a.y() + (b.y() - a.y()) * (s - a.x()) / (b.x() - a.x());
    }
    return points_.back().y();
  }

 private:
  std::vector<Eigen::Vector2f> points_;
};

/// The side view of a body: heights as shares of the car's height, places as shares of its length.
struct CarProfile {
  Curve top;          // of the body's middle, hood to tail
  Curve belt;         // lower edge of the side windows
  float screen_low;   // windscreen's foot
  float screen_high;  // and its upper edge
  float rear_high;    // rear window's upper edge
  float rear_low;     // and its foot
  float pillar_b;     // between front and rear doors
  float pillar_c;     // behind the rear doors; cabin glass may go on behind it (estate, van)
  float side_end;     // where the side glass ends
  float front_axle;
  float rear_axle;
  float wheel_radius;  // m
};

CarProfile carProfile(CarBody body);

}  // namespace parkade::sim
