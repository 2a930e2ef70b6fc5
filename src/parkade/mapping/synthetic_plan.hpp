// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/types/semantic_features.hpp"

// For tests only: a drawn garage, and what the semantics room would say of it.

namespace parkade::testing {

struct PlanLine {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double width = 0.12;
  SemanticClass semantic_class = SemanticClass::kSlotLine;
};

struct PlanSlot {
  std::array<Eigen::Vector2d, 4> corners;
  bool occupied = false;
  std::string number;
};

struct PlanObject {
  SemanticClass semantic_class = SemanticClass::kArrow;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double heading = 0.0;
  std::string text;
  Eigen::Vector2d size = Eigen::Vector2d::Constant(0.6);  ///< along and across the heading
};

struct PlanMover {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double heading = 0.0;
  Eigen::Vector2d size = {4.4, 1.8};
};

/// A garage as geometry. The floor is the box from min to max; beyond it nothing is seen.
struct Plan {
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  Eigen::Vector2d max = Eigen::Vector2d::Zero();
  std::vector<PlanLine> lines;
  std::vector<PlanSlot> slots;
  std::vector<PlanObject> objects;
  std::vector<PlanMover> movers;
};

/// Two rows of perpendicular slots along each of `aisles` aisles (along x, length m), joined by
/// cross aisles at both ends; arrows, pillars with zone markers, parked cars. Slots repeat exactly:
/// the look-alike case. The aisles' middles lie at y = 16 k.
Plan makePlan(int aisles, double length, double occupancy, std::uint64_t seed);

/// A closed drive around the block between the first two aisles, from (0, 0) eastwards, `laps`
/// times, with turns of 5 m radius; a pose every `step` metres.
std::vector<SE2> blockDrive(double length, int laps, double step);

struct ObserverNoise {
  double line_sigma = 0.0;        ///< m, across lines
  double corner_sigma = 0.0;      ///< m
  double object_sigma = 0.0;      ///< m
  double attitude_sigma = 0.0;    ///< rad, of pitch and of roll, new for every frame
  double dropout = 0.0;           ///< share of line points, slots and objects that are not seen
  double outliers = 0.0;          ///< share of line points that lie anywhere
  double label_noise = 0.0;       ///< share of pixels with another class
  double availability_error = 0;  ///< share of slots said to be free or occupied wrongly
  double range_m = 7.5;
};

/// Noise as that of pictures on a good floor.
ObserverNoise usualNoise();

/// Sees a plan from poses, occluded by parked and moving cars.
class PlanObserver {
 public:
  PlanObserver(const Plan& plan, const ObserverNoise& noise);
  /// draw_labels: with the picture, else line points, slots and objects only.
  [[nodiscard]] SemanticFrame observe(TimeNs t_ns, const SE2& T_world_vehicle, Random& random,
                                      bool draw_labels) const;
  [[nodiscard]] SemanticClass classAt(const Eigen::Vector2d& p_world) const;
  /// Where the plan's movers stand now.
  Plan& plan() { return plan_; }

 private:
  void rasterise();
  Plan plan_;
  ObserverNoise noise_;
  double cell_ = 0.02;
  int width_ = 0;
  std::vector<std::uint8_t> raster_;
};

/// The plan as a perfect map of it: layers, slots, objects; seen from T_map_plan.
ParkingMap mapOf(const Plan& plan, const SE2& T_map_plan = {});

inline bool insideBox(const Eigen::Vector2d& p, const Eigen::Vector2d& center, double heading,
                      const Eigen::Vector2d& size) {
  const Eigen::Vector2d q = SE2(heading, center).inverse() * p;
  return std::abs(q.x()) <= 0.5 * size.x() && std::abs(q.y()) <= 0.5 * size.y();
}

}  // namespace parkade::testing
