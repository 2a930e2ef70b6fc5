// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/mapping/layered_grid.hpp"
#include "parkade/types/semantic_class.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// A parking slot of the map. World frame, metres.
struct MapSlot {
  std::int64_t id = 0;  ///< stable: never used again for another slot
  /// Entrance left, entrance right (as a driver entering nose first sees them), rear right, rear
  /// left; on the middle of the painted lines.
  std::array<Eigen::Vector2d, 4> corners = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                            Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  /// m, standard deviation of the entrance corners, per axis; with what all looks share.
  double corner_sigma = 0.0;
  SlotShape shape = SlotShape::kPerpendicular;
  std::string number;  ///< painted; read, or told by those of its bay (bay_numbers.hpp)
  std::string zone;    ///< zone marker nearby, empty where not read
  /// When the map is told, not at last_seen_ns: what was seen then has faded since.
  double probability_free = 0.5;
  std::int64_t observations = 0;  ///< 0: told by its row (row_completion.hpp)
  TimeNs last_seen_ns = 0;
  /// Middle of the entrance.
  [[nodiscard]] Eigen::Vector2d entrance() const { return 0.5 * (corners[0] + corners[1]); }
  /// Told to be free or occupied; between the two it is open.
  [[nodiscard]] bool isFree() const { return probability_free > 0.65; }
  [[nodiscard]] bool isOccupied() const { return probability_free < 0.35; }
  bool operator==(const MapSlot&) const = default;
};

/// Anything else with a place: arrow, limit, stop line, crossing, bump, pillar, zone marker, sign.
struct MapObject {
  std::int64_t id = 0;
  SemanticClass semantic_class = SemanticClass::kUnknown;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double heading = 0.0;         ///< rad: direction of travel it speaks to, or its face's normal
  double position_sigma = 0.0;  ///< m, per axis; with what all looks share
  std::string text;             ///< "B12", "10", "straight_left", "EXIT"
  std::vector<Eigen::Vector2d> outline;  ///< on the ground, counter-clockwise; may be empty
  std::int64_t observations = 0;
  bool operator==(const MapObject&) const = default;
};

/// Where the objects of a class stand, over the ground.
inline std::vector<Eigen::Vector2d> positionsOf(SemanticClass semantic_class,
                                                const std::vector<MapObject>& objects) {
  std::vector<Eigen::Vector2d> positions;
  for (const MapObject& object : objects) {
    if (object.semantic_class == semantic_class) positions.push_back(object.position.head<2>());
  }
  return positions;
}

struct PoseGraphNode {
  std::int64_t id = 0;
  TimeNs t_ns = 0;
  SE3 T_world_vehicle;
};

enum class EdgeKind : std::uint8_t { kOdometry = 0, kLoop = 1 };

struct PoseGraphEdge {
  std::int64_t from = 0;
  std::int64_t to = 0;
  EdgeKind kind = EdgeKind::kOdometry;
  SE3 T_from_to;
  Matrix6d information = Matrix6d::Identity();
};

/// The map that a planner uses and that localisation starts from.
struct ParkingMap {
  std::string name;
  LayeredGrid grid;
  std::vector<MapSlot> slots;      ///< ordered by id
  std::vector<MapObject> objects;  ///< ordered by id
  std::vector<PoseGraphNode> nodes;
  std::vector<PoseGraphEdge> edges;
};

}  // namespace parkade
