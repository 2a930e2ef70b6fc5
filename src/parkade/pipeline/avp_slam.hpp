// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "parkade/core/options.hpp"
#include "parkade/fusion/odometry.hpp"
#include "parkade/localization/point_icp.hpp"
#include "parkade/pipeline/semantic_mapper.hpp"

namespace parkade {

struct AvpSlamOptions {
  double local_map_m = 30.0;
  double range_m = 8.0;
  double cell_m = 0.1;
  double localise_distance_m = 1.0;
  double sigma_m = 0.05;
  double sigma_deg = 0.3;
  double gate_probability = 0.999;
  double loop_share = 0.35;
  double loop_sigma_m = 1.0;
  PointIcpOptions icp;
  OdometryNoiseOptions odometry{.translation = 0.02, .yaw_deg = 0.05, .told_share = 1.0};

  void visit(OptionVisitor& v) {
    v.field("local_map_m", local_map_m, "m", "A local map holds this much of the drive.", 2.0,
            500.0);
    v.field("range_m", range_m, "m", "Points farther from the picture's middle are not used.", 1.0,
            50.0);
    v.field("cell_m", cell_m, "m", "Points are thinned to one per cell of this side.", 0.02, 1.0);
    v.field("localise_distance_m", localise_distance_m, "m",
            "Between pictures that are registered to the map.", 0.05, 50.0);
    v.field("sigma_m", sigma_m, "m", "Error of such a registration's place, per axis.", 1e-3, 5.0);
    v.field("sigma_deg", sigma_deg, "deg", "And of its heading.", 1e-3, 30.0);
    v.field("gate_probability", gate_probability, "probability",
            "Registrations that are kept, of those that are right.", 0.5, 0.999999);
    v.field("loop_share", loop_share, "ratio",
            "Share of a local map's points that a loop must pair: two of them overlap in part.",
            0.05, 1.0);
    v.field("loop_sigma_m", loop_sigma_m, "m",
            "Where the place is less sure than this, loops are not looked for: rows look alike.",
            0.1, 100.0);
    v.group("icp", icp);
    v.group("odometry", odometry);
  }
};

struct AvpSlamStatistics {
  int local_maps = 0;
  int registrations = 0;
  int accepted = 0;
  int loops = 0;
};

/// AVP-SLAM's scheme (Qin, Chen, Chen and Su, "AVP-SLAM: Semantic visual mapping and localization
/// for autonomous vehicles in the parking lot", 2020), as the open baseline: semantic points of the
/// bird's-eye picture are laid by odometry into local maps of 30 m; ICP between local maps closes
/// loops; a pose graph over local maps corrects them; ICP of the picture to the map and odometry
/// meet in an EKF over (x, y, yaw). What the paper leaves open: docs/avp-slam.md.
class AvpSlam final : public SemanticMapper {
 public:
  explicit AvpSlam(const AvpSlamOptions& options);
  ~AvpSlam() override;

  PoseEstimate addOdometry(const PoseEstimate& odometry) override;
  void holdView() override;
  void dropView() override;
  PoseEstimate addSemantics(const SemanticFrame& frame,
                            const std::vector<LevelView>& views) override;
  [[nodiscard]] PoseEstimate estimate() const override;
  void finish() override;
  [[nodiscard]] ParkingMap map(const std::string& name) const override;
  [[nodiscard]] Trajectory finalTrajectory() const override;
  [[nodiscard]] const AvpSlamStatistics& statistics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
