// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/layered_grid.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Key points above the floor, each where it was last told, hung on anchors that may move.
class WallPoints {
 public:
  /// Points of a frame that was taken at T_anchor_vehicle; heights count above the floor there.
  void add(const std::vector<RaisedPoint>& points, std::int64_t anchor,
           const SE2& T_anchor_vehicle);
  /// Their places in the map, by the anchors' present poses (T_map_anchor), and heights above the
  /// floor; in the order of ids.
  [[nodiscard]] std::vector<Eigen::Vector3d> places(
      const std::function<SE2(std::int64_t)>& poseOf) const;

 private:
  struct Point {
    std::int64_t anchor = 0;
    Eigen::Vector2d p_anchor;
    double z = 0.0;
  };
  std::map<std::uint64_t, Point> points_;
};

/// Where sight from the car's way first meets a wall of the structure layer, within `range` m and
/// with no pillar before it: a place every 0.25 m, as places() tells them, once low and once high.
std::vector<Eigen::Vector3d> wallFronts(const LayeredGrid& grid, const std::vector<SE2>& way,
                                        double range);

/// A straight piece of a wall's face, map frame, m.
struct WallFace {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

/// Places nearer than this to a face lie on it, m: of key points, and of labels.
inline constexpr double kPointsOnFace = 0.06;
inline constexpr double kLabelsOnFace = 0.1;

/// Faces of walls that places (WallPoints::places(), wallFronts()) lie on: along the two square
/// directions that most points line up with, straight pieces of at least 4 m with a point every 3 m
/// and at least 10, that hold most of what lies within 0.4 m of them, and show it higher than cars
/// are as well as lower than pipes run. Points at pillars, of which objects tells, are theirs.
/// on_face: m, above. docs/math/grid.md.
std::vector<WallFace> findWallFaces(const std::vector<Eigen::Vector3d>& places,
                                    const std::vector<MapObject>& objects, double on_face);

/// Draws faces into the structure layer as walls 0.2 m deep, on the side that less of them is seen
/// from, from everywhere on the car's way within `range` m and past the map's walls and pillars;
/// but for those that run through told slots, parked vehicles or the way itself.
void drawWalls(const std::vector<WallFace>& faces, const std::vector<MapSlot>& slots,
               const std::vector<SE2>& way, double range, LayeredGrid& grid);

/// Takes walls back that stand inside told slots, 0.1 m off their edges: none do.
void forgetWallsInSlots(const std::vector<MapSlot>& slots, LayeredGrid& grid);

/// Takes floor back that lies behind a face, and where it goes on, up to 8 m from its ends: a strip
/// of at most 1.3 m, with nothing known behind it. Far walls are taken for floor; where floor lies
/// deeper, the wall has an opening or an end.
void forgetFloorBeyondWalls(const std::vector<WallFace>& faces, LayeredGrid& grid);

}  // namespace parkade
