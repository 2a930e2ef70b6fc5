// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/wall_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/layers/way_eyes.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Eigen::Vector3d;

// A told slot, as walls may not run through it: off its lines by a bumper's play, and where it is
// entered.
struct SlotGround {
  explicit SlotGround(const MapSlot& slot)
      : entrance_left(slot.corners[0]),
        entrance_right(slot.corners[1]),
        inside(inset(slot.corners, kInside)) {}

  [[nodiscard]] bool holds(const Vector2d& p) const {
    return distanceToSegment(p, entrance_left, entrance_right) < kEntrance || contains(inside, p);
  }

  static constexpr double kInside = 0.3;    // m
  static constexpr double kEntrance = 0.4;  // m
  Vector2d entrance_left;
  Vector2d entrance_right;
  std::array<Vector2d, 4> inside;
};

bool inSlot(const std::vector<SlotGround>& slots, const Vector2d& p) {
  return std::any_of(slots.begin(), slots.end(),
                     [&](const SlotGround& slot) { return slot.holds(p); });
}

bool besideVehicle(const LayeredGrid& grid, const Vector2d& p) {
  constexpr int kCells = 2;
  const Vector2i cell = grid.cellOf(p);
  for (int dy = -kCells; dy <= kCells; ++dy) {
    for (int dx = -kCells; dx <= kCells; ++dx) {
      if (grid.at(GridLayer::kAvailability, cell + Vector2i(dx, dy)).believed() ==
          SemanticClass::kVehicle) {
        return true;
      }
    }
  }
  return false;
}

const SE2& nearestOf(const std::vector<SE2>& way, const Vector2d& p) {
  return *std::min_element(way.begin(), way.end(), [&](const SE2& a, const SE2& b) {
    return (a.translation() - p).squaredNorm() < (b.translation() - p).squaredNorm();
  });
}

// Whether a wall or a pillar of the map stands between an eye and a face's place, but for what is
// labelled as one right before it.
bool isHidden(const LayeredGrid& grid, const Vector2d& eye, const Vector2d& p) {
  constexpr double kBefore = 0.5;  // m
  constexpr int kOpaque = 2;       // cells
  const double distance = (p - eye).norm();
  const Vector2d step = grid.resolution() / distance * (p - eye);
  const int count = static_cast<int>((distance - kBefore) / grid.resolution());
  int inside = 0;
  for (int n = 0; n < count; ++n) {
    const Vector2i cell = grid.cellOf(eye + n * step);
    inside = isStructure(grid.at(GridLayer::kZoneMarkers, cell).believed()) ? inside + 1 : 0;
    if (inside >= kOpaque) return true;
  }
  return false;
}

// The side of a face that the car's way does not see, or sees less of, by apparent size.
Vector2d behind(const WallFace& face, const std::vector<Vector2d>& eyes, double range,
                const LayeredGrid& grid) {
  constexpr double kSpacing = 0.5;  // m
  const Vector2d along = (face.to - face.from).normalized();
  const Vector2d left(-along.y(), along.x());
  const double length = (face.to - face.from).norm();
  double from_left = 0.0;
  for (double s = 0.5 * kSpacing; s < length; s += kSpacing) {
    const Vector2d p = face.from + s * along;
    for (const Vector2d& eye : eyes) {
      const double distance = (eye - p).norm();
      if (distance > range || distance < 1e-3 || isHidden(grid, eye, p)) continue;
      from_left += left.dot(eye - p) / (distance * distance);
    }
  }
  return from_left > 0.0 ? Vector2d(-left) : left;
}

// Wall from the face's places on, and none before them, where labels are smeared.
void drawFace(const std::vector<Vector2d>& places, const Vector2d& away, double step,
              LayeredGrid& grid) {
  constexpr double kDeep = 0.2;      // m
  constexpr double kSmeared = 0.35;  // m before the face
  constexpr float kLogOdds = 2.0F;
  constexpr GridLayer kLayer = GridLayer::kZoneMarkers;
  std::vector<Vector2i> before;
  for (const Vector2d& p : places) {
    for (double s = grid.resolution(); s < kSmeared; s += step) {
      const Vector2i cell = grid.cellOf(p - s * away);
      if (grid.at(kLayer, cell).believed() == SemanticClass::kWall) before.push_back(cell);
    }
  }
  grid.forget(kLayer, before);
  const int deep = static_cast<int>(std::lround(kDeep / step));
  for (const Vector2d& p : places) {
    for (int k = 0; k < deep; ++k) {
      grid.set(kLayer, grid.cellOf(p + k * step * away), SemanticClass::kWall, kLogOdds);
    }
  }
}

}  // namespace

void WallPoints::add(const std::vector<RaisedPoint>& points, std::int64_t anchor,
                     const SE2& T_anchor_vehicle) {
  for (const RaisedPoint& point : points) {
    points_[point.id] = {anchor, T_anchor_vehicle * Vector2d(point.p_level.head<2>()),
                         point.p_level.z()};
  }
}

std::vector<Vector3d> WallPoints::places(const std::function<SE2(std::int64_t)>& poseOf) const {
  std::vector<Vector3d> places;
  for (const auto& [id, point] : points_) {
    const Vector2d p = poseOf(point.anchor) * point.p_anchor;
    places.emplace_back(p.x(), p.y(), point.z);
  }
  return places;
}

void drawWalls(const std::vector<WallFace>& faces, const std::vector<MapSlot>& slots,
               const std::vector<SE2>& way, double range, LayeredGrid& grid) {
  constexpr double kRefused = 0.3;  // of a face, at most, that something else explains
  constexpr double kHalfCar = 0.9;  // m
  if (way.empty()) return;
  const double step = 0.5 * grid.resolution();
  const std::vector<SlotGround> grounds(slots.begin(), slots.end());
  std::vector<Vector2d> eyes;
  forEachEye(way, [&](const Vector2d& eye) { eyes.push_back(eye); });
  for (const WallFace& face : faces) {
    const double length = (face.to - face.from).norm();
    const Vector2d along = (face.to - face.from) / length;
    std::vector<Vector2d> wall;
    int refused = 0;
    const int count = static_cast<int>(length / step) + 1;
    for (int k = 0; k < count; ++k) {
      const Vector2d p = face.from + k * step * along;
      const bool elsewise = inSlot(grounds, p) || besideVehicle(grid, p) ||
                            (nearestOf(way, p).translation() - p).norm() < kHalfCar;
      if (elsewise) {
        ++refused;
      } else {
        wall.push_back(p);
      }
    }
    if (refused <= kRefused * count) drawFace(wall, behind(face, eyes, range, grid), step, grid);
  }
}

}  // namespace parkade
