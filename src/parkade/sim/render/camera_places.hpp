// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "parkade/geometry/se3.hpp"

namespace parkade::sim {

/// A camera on a moving car.
struct CameraMotion {
  std::function<SE3(double t)> T_world_vehicle;
  SE3 T_vehicle_cam;
  double readout_time = 0.0;  ///< s from the first row to the last; 0: all at once
};

/// Where a camera stands while it takes a picture: at one place, or, where it reads its rows one
/// after the other (rolling shutter), at one for each row.
class CameraPlaces {
 public:
  /// All rows at once.
  CameraPlaces(const SE3& T_world_cam)  // NOLINT(google-explicit-constructor): a place is one
      : middle_(T_world_cam) {}
  /// Row by row; t is when the middle one is read, s.
  CameraPlaces(const CameraMotion& motion, double t, int rows);

  [[nodiscard]] bool rolling() const { return !rows_.empty(); }
  [[nodiscard]] const Eigen::Matrix3f& rotation(int row) const { return at(row).R; }
  [[nodiscard]] const Eigen::Vector3f& eye(int row) const { return at(row).eye; }
  /// Of the middle row.
  [[nodiscard]] const Eigen::Matrix3f& rotation() const { return middle_.R; }
  [[nodiscard]] const Eigen::Vector3f& eye() const { return middle_.eye; }

 private:
  struct Place {
    explicit Place(const SE3& T_world_cam)
        : R(T_world_cam.rotation().matrix().cast<float>()),
          eye(T_world_cam.translation().cast<float>()) {}
    Eigen::Matrix3f R;  ///< from camera to world axes
    Eigen::Vector3f eye;
  };
  /// Rows below the picture, which the last tile's table has, are as its last one.
  [[nodiscard]] const Place& at(int row) const {
    if (rows_.empty()) return middle_;
    const auto last = rows_.size() - 1;
    return rows_[std::min(static_cast<std::size_t>(row), last)];
  }

  Place middle_;
  std::vector<Place> rows_;  ///< empty: all as the middle
};

}  // namespace parkade::sim
