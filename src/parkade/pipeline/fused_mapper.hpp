// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "parkade/mapping/local_map.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/pipeline/fused_mapper_options.hpp"
#include "parkade/pipeline/semantic_mapper.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct FusedMapperStatistics {
  int registrations = 0;  ///< tried on submaps of this passage
  int accepted = 0;
  int revisits = 0;  ///< tried on submaps of an earlier one
  int loops = 0;     ///< of them, accepted
  int refused_by_gate = 0;
  int map_registrations = 0;  ///< to a saved map, tried since the car was found in it
  int map_accepted = 0;
  int headings = 0;  ///< read off the garage's axes, and taken
  int anchors = 0;
};

/// Fused localisation and mapping: odometry predicts, the registration of each frame's semantic
/// features to submaps of earlier stretches corrects, and all that was seen enters the map, which
/// follows the corrections. Eats poses and features, never images. The same calls give the same
/// bytes. Not thread-safe.
class FusedMapper final : public SemanticMapper {
 public:
  /// viewpoints: the cameras' places in the vehicle frame.
  FusedMapper(const FusedMapperOptions& options, std::vector<Eigen::Vector3d> viewpoints);
  ~FusedMapper() override;

  Status locateIn(const ParkingMap& map) override;
  PoseEstimate addOdometry(const PoseEstimate& odometry) override;
  void holdView() override;
  void dropView() override;
  PoseEstimate addSemantics(const SemanticFrame& frame,
                            const std::vector<LevelView>& views) override;
  [[nodiscard]] PoseEstimate estimate() const override;
  void finish() override;
  [[nodiscard]] ParkingMap map(const std::string& name) const override;
  /// Each pose between the anchors before and after it, as the filter knows them in the end: an
  /// anchor's pose holds all that was measured since.
  [[nodiscard]] Trajectory finalTrajectory() const override;

  [[nodiscard]] const LocalMap* localMap() const override;
  [[nodiscard]] const LayeredGrid& globalGrid() const;
  [[nodiscard]] const FusedMapperStatistics& statistics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
