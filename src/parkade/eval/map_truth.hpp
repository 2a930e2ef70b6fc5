// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/types/semantic_class.hpp"
#include "parkade/types/semantic_features.hpp"
#include "parkade/types/trajectory.hpp"

// What a garage is in truth, as plain data: whoever knows it (a simulator, a surveyor) fills it in.
// All positions are in the truth's frame, metres.

namespace parkade {

struct TruthSlot {
  /// Entrance left, entrance right, rear right, rear left, as MapSlot's.
  std::array<Eigen::Vector2d, 4> corners = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                            Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  std::string number;     ///< empty where none is painted
  std::string zone;       ///< empty where there is none
  bool occupied = false;  ///< by a parked vehicle, all the time
};

/// Area that shows a class: paint, or the foot of something that stands.
struct TruthArea {
  SemanticClass semantic_class = SemanticClass::kUnknown;
  std::vector<Eigen::Vector2d> outline;
};

struct TruthObject {
  SemanticClass semantic_class = SemanticClass::kUnknown;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::string text;  ///< empty: not judged
  /// Directions that it can be seen from (a sign's face); empty: all.
  std::vector<Eigen::Vector2d> faces;
  int places = 1;  ///< so many objects of a map may stand for it (the faces of one pillar)
};

/// A vehicle over the ground at an instant.
struct TruthVehicle {
  TimeNs t_ns = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
};

struct MapTruth {
  std::vector<TruthSlot> slots;
  std::vector<TruthArea> areas;
  std::vector<TruthObject> objects;
  std::vector<TruthVehicle> vehicles;  ///< that move, ordered by time
  Trajectory driven;                   ///< of the mapping vehicle, T_truth_vehicle
};

}  // namespace parkade
