// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/mapping/local_map.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/types/level_view.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/semantic_features.hpp"
#include "parkade/types/trajectory.hpp"

namespace parkade {

/// Corrects an odometry by semantic features and makes a map. Eats poses and features, never
/// images; the same calls give the same bytes. Not thread-safe.
class SemanticMapper {
 public:
  virtual ~SemanticMapper() = default;

  /// Before all else: the world is to be that of a saved map, where the car has to be found first.
  /// Until then poses have the health kInitialising. Fails where the method cannot.
  virtual Status locateIn(const ParkingMap& /*map*/) {
    return Error{"this method cannot find the car in a saved map"};
  }
  /// The odometry's pose of a frame set. Gives the corrected pose, T_world_vehicle in its place of
  /// T_odom_vehicle; the odometry's own while that has not started.
  virtual PoseEstimate addOdometry(const PoseEstimate& odometry) = 0;
  /// Keeps the last odometry's frame set as one whose features will come, a few frame sets later.
  virtual void holdView() = 0;
  /// The features of the first frame set held (of the last one given to addOdometry(), where none
  /// is held). views: labels of cameras' own pictures of that frame set, any number of them. Gives
  /// the last frame set's pose anew.
  virtual PoseEstimate addSemantics(const SemanticFrame& frame,
                                    const std::vector<LevelView>& views) = 0;

  /// The first frame set held gets no features after all.
  virtual void dropView() = 0;
  /// The last frame set's pose as known now.
  [[nodiscard]] virtual PoseEstimate estimate() const = 0;

  /// Ends a run: takes up all corrections.
  virtual void finish() = 0;
  /// The map as it is; finish() first, at the end of a run.
  [[nodiscard]] virtual ParkingMap map(const std::string& name) const = 0;
  /// The layers around the car as a planner sees them, in the odometry's frame; null where the
  /// method keeps none.
  [[nodiscard]] virtual const LocalMap* localMap() const { return nullptr; }
  /// Every frame set since the start, with all that came after it.
  [[nodiscard]] virtual Trajectory finalTrajectory() const = 0;
};

}  // namespace parkade
