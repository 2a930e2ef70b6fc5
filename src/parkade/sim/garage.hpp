// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "parkade/geometry/se3.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade::sim {

// The truth of a garage as vector objects, in the garage frame (x, y in the plane of the level's
// floor datum, z up, metres). Geometry and materials made from it are a Scene (scene.hpp).

enum class SlotType : std::uint8_t { kPerpendicular, kParallel, kSlanted };
enum class SlotMarking : std::uint8_t { kClosed, kTShaped, kLShaped, kOpen };

/// One parking slot.
struct Slot {
  int id = 0;
  /// Entrance left, entrance right (as a driver entering nose first sees them), rear right, rear
  /// left; on the centre lines of the painted lines.
  std::array<Eigen::Vector2d, 4> corners;
  SlotType type = SlotType::kPerpendicular;
  SlotMarking marking = SlotMarking::kClosed;
  std::string number;  ///< painted number, empty where none
  std::string zone;    ///< of the nearest zone marker, "B2"
  bool occupied = false;
};

/// One painted or mounted thing on the floor: an arrow, a limit, a stop line, a bump, a line.
struct Marking {
  int id = 0;
  SemanticClass semantic_class = SemanticClass::kUnknown;
  std::vector<std::vector<Eigen::Vector2d>> polygons;  ///< counter-clockwise outlines, union
  std::string meaning;  ///< arrow: straight, left, right, straight_left, ...; limit: "10"; text
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< reference point
  double heading = 0.0;  ///< rad: the direction of travel it speaks to
  Eigen::Vector3f colour = Eigen::Vector3f::Constant(0.75F);  ///< linear RGB reflectance, unworn
};

struct Pillar {
  int id = 0;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< m along x and y
  double height = 0.0;
  bool round = false;     ///< size is then the diameter
  std::string zone_text;  ///< "B12", empty where unmarked
};

/// A walled block inside the outline (stairs, lifts, plant): nothing drives or parks there.
struct Room {
  int id = 0;
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  Eigen::Vector2d max = Eigen::Vector2d::Zero();
};

/// Where the ramp from outside comes in through an outer wall.
struct Entrance {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< on the outline
  double heading = 0.0;                              ///< rad, into the garage
  double width = 5.5;                                ///< m
};

/// A flat sign: text on a pillar's face (zone marker), a hanging guide sign, a speed-limit sign.
struct Sign {
  int id = 0;
  SemanticClass semantic_class = SemanticClass::kGuideSign;
  SE3 T_world_sign;  ///< x right and y up on the sign as its reader sees it, z to the reader
  double width = 0.0;
  double height = 0.0;
  std::string text;  ///< "B12", "EXIT", "exit_left", "10"
};

/// The drivable network: centre lines of aisles, for routes and agents.
struct AisleGraph {
  struct Edge {
    int from = 0;
    int to = 0;
    double width = 6.0;  ///< m, free width for driving
    bool one_way = false;
    double speed_limit = 2.8;  ///< m/s
  };
  std::vector<Eigen::Vector2d> nodes;
  std::vector<Edge> edges;
};

struct Garage {
  std::string name;  ///< "paper", "random"
  std::uint64_t seed = 0;
  Eigen::Vector2d min = Eigen::Vector2d::Zero();  ///< bounds of the floor
  Eigen::Vector2d max = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> outline;  ///< inner faces of the outer walls, counter-clockwise
  double ceiling_height = 2.8;
  std::vector<Slot> slots;
  std::vector<Marking> markings;
  std::vector<Pillar> pillars;
  std::vector<Room> rooms;
  std::vector<Entrance> entrances;
  std::vector<Sign> signs;
  AisleGraph aisles;
  double line_width = 0.12;
  /// Height of the smooth floor (ramps, falls; speed bumps excluded): a sum of ramps, each
  /// rise * (u - sin(2 pi u) / (2 pi)) with u the share of its length, so the slope is at most
  /// 2 * rise / length.
  struct Ramp {
    Eigen::Vector2d start = Eigen::Vector2d::Zero();
    Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit; the height changes along it
    double length = 1.0;  ///< m over which the height changes, smoothly (C2)
    double rise = 0.0;    ///< m
  };
  std::vector<Ramp> ramps;
  /// Speed bumps raise wheels that roll over them: height * (1 - s^2)^3 along the heading (s = -1
  /// to 1 over the length), falling to the floor over the last 5 cm across.
  struct Bump {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    double heading = 0.0;  ///< rad, direction of travel across it
    double length = 0.35;  ///< m along the heading
    double width = 5.0;    ///< m across
    double height = 0.04;  ///< m
  };
  std::vector<Bump> bumps;

  [[nodiscard]] double area() const;                                   ///< of the outline, m^2
  [[nodiscard]] double floorHeight(const Eigen::Vector2d& p) const;    ///< smooth part
  [[nodiscard]] double surfaceHeight(const Eigen::Vector2d& p) const;  ///< with bumps
  /// The stretches of an outer wall from a to b that entrances open, m after a, in their order.
  [[nodiscard]] std::vector<std::pair<double, double>> openings(const Eigen::Vector2d& a,
                                                                const Eigen::Vector2d& b) const;
};

}  // namespace parkade::sim
