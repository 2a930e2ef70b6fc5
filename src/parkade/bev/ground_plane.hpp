// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "parkade/bev/floor_elevation.hpp"
#include "parkade/core/options.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/ground_relief.hpp"
#include "parkade/types/landmark.hpp"
#include "parkade/types/pose_estimate.hpp"

namespace parkade {

struct GroundPlaneOptions {
  double max_distance_m = 7.0;
  double keep_s = 15.0;
  double tilt_prior_deg = 0.7;
  double height_prior_m = 0.02;
  double point_sigma_m = 0.01;
  double max_off_plane_m = 0.12;
  FloorElevationOptions elevation;

  void visit(OptionVisitor& v) {
    v.field("max_distance_m", max_distance_m, "m", "Landmarks this near to the car tell its floor.",
            1.0, 50.0);
    v.field("keep_s", keep_s, "s", "Landmarks are kept this long after they were last seen.", 0.0,
            600.0);
    v.field("tilt_prior_deg", tilt_prior_deg, "deg",
            "Pitch and roll of the body to the floor, 1 sigma, before any landmark.", 0.01, 10.0);
    v.field("height_prior_m", height_prior_m, "m",
            "Height of the body over its place at rest, 1 sigma, before any landmark.", 1e-4, 1.0);
    v.field("point_sigma_m", point_sigma_m, "m",
            "Unevenness of the floor and error of a near landmark, 1 sigma.", 1e-4, 1.0);
    v.field("max_off_plane_m", max_off_plane_m, "m",
            "Landmarks further above or below the expected floor are no floor.", 0.005, 2.0);
    v.group("elevation", elevation);
  }
};

/// How the body stands over the floor, with how sure that is.
struct GroundPlaneEstimate {
  GroundAttitude attitude;    ///< over the plane that fits the floor within 6 m best
  GroundRelief relief;        ///< the floor over that plane
  double sigma_pitch = 0.0;   ///< rad
  double sigma_roll = 0.0;    ///< rad
  double sigma_height = 0.0;  ///< m
  int points = 0;             ///< landmarks that the plane rests on
};

/// Finds the floor under the car among the odometry's landmarks: a robust plane through those near
/// the car that lie where the floor may be, around the attitude at rest, and the floor's elevation
/// over it. Floors slope and bodies pitch, so neither gravity nor the vehicle frame tells it
/// (docs/math/ipm.md, eqs. 6 to 10).
class GroundPlaneEstimator {
 public:
  explicit GroundPlaneEstimator(const GroundPlaneOptions& options)
      : options_(options), elevation_(options.elevation) {}

  /// Takes a pose and the landmarks known at it, all in odom; call it once per frame set, in order.
  /// Without enough landmarks the estimate falls back towards the prior and its sigma says so.
  GroundPlaneEstimate update(const PoseEstimate& pose, const std::vector<Landmark>& landmarks);

  void reset();

 private:
  struct Point {
    Eigen::Vector3d p_odom = Eigen::Vector3d::Zero();
    double sigma = 0.0;  ///< m, vertical
    TimeNs last_seen_ns = 0;
  };
  void remember(const PoseEstimate& pose, const std::vector<Landmark>& landmarks);
  void addRelief(const SE3& T_odom_vehicle, const Eigen::Vector3d& plane,
                 GroundPlaneEstimate& estimate);

  GroundPlaneOptions options_;
  FloorElevation elevation_;
  std::unordered_map<std::uint64_t, Point> points_;
  bool has_plane_ = false;
  Eigen::Vector3d plane_odom_ = Eigen::Vector3d::Zero();  ///< z = a x + b y + c of the last frame
};

}  // namespace parkade
