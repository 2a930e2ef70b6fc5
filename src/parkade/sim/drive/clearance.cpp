// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/clearance.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace parkade::sim {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;  // convex

struct Obstacle {
  Polygon polygon;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius = 0.0;
  std::string name;
};

Obstacle makeObstacle(Polygon polygon, std::string name) {
  Obstacle obstacle;
  for (const Eigen::Vector2d& p : polygon) {
    obstacle.center += p / static_cast<double>(polygon.size());
  }
  for (const Eigen::Vector2d& p : polygon) {
    obstacle.radius = std::max(obstacle.radius, (p - obstacle.center).norm());
  }
  obstacle.polygon = std::move(polygon);
  obstacle.name = std::move(name);
  return obstacle;
}

Polygon box(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

// Largest gap between two convex polygons over the normals of the first one's sides.
double gapAlongNormals(const Polygon& a, const Polygon& b) {
  double gap = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d side = a[(i + 1) % a.size()] - a[i];
    Eigen::Vector2d normal(side.y(), -side.x());
    normal.normalize();
    double a_high = -std::numeric_limits<double>::infinity();
    double b_low = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& p : a) a_high = std::max(a_high, normal.dot(p));
    for (const Eigen::Vector2d& p : b) b_low = std::min(b_low, normal.dot(p));
    gap = std::max(gap, b_low - a_high);
  }
  return gap;
}

// Both polygons counter-clockwise; a separating axis gives a lower bound of the distance.
double gapBetween(const Polygon& a, const Polygon& b) {
  return std::max(gapAlongNormals(a, b), gapAlongNormals(b, a));
}

Polygon counterClockwise(Polygon polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  if (twice < 0.0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

std::vector<Obstacle> obstaclesOf(const Garage& garage, int free_slot_id) {
  std::vector<Obstacle> obstacles;
  for (const Pillar& pillar : garage.pillars) {
    obstacles.push_back(
        makeObstacle(box(pillar.center - 0.5 * pillar.size, pillar.center + 0.5 * pillar.size),
                     fmt::format("pillar {}", pillar.id)));
  }
  for (const Room& room : garage.rooms) {
    obstacles.push_back(makeObstacle(box(room.min, room.max), fmt::format("room {}", room.id)));
  }
  for (const Slot& slot : garage.slots) {
    if (!slot.occupied || slot.id == free_slot_id) continue;
    obstacles.push_back(makeObstacle(counterClockwise({slot.corners.begin(), slot.corners.end()}),
                                     fmt::format("slot {}", slot.id)));
  }
  return obstacles;
}

Polygon outlineOf(const VehicleShape& car, const PathPoint& axle) {
  const Eigen::Vector2d forward(std::cos(axle.heading), std::sin(axle.heading));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  const Eigen::Vector2d front = axle.position + (car.wheelbase + car.front_overhang) * forward;
  const Eigen::Vector2d rear = axle.position - car.rear_overhang * forward;
  const Eigen::Vector2d half = 0.5 * car.width * left;
  return {rear - half, front - half, front + half, rear + half};
}

// Signed distance of a point from the outline's sides, > 0 inside; exact for convex outlines and a
// lower bound near reflex corners.
double insideOutline(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d d = outline[(i + 1) % outline.size()] - a;
    least = std::min(least, (d.x() * (p - a).y() - d.y() * (p - a).x()) / d.norm());
  }
  return least;
}

}  // namespace

Clearance clearanceOf(const Path& path, const Garage& garage, const VehicleShape& car,
                      int free_slot_id) {
  const std::vector<Obstacle> obstacles = obstaclesOf(garage, free_slot_id);
  const double reach = car.wheelbase + car.front_overhang + car.width;
  Clearance nearest;
  const auto note = [&nearest](double distance, double s, const std::string& name) {
    if (distance < nearest.distance) nearest = {distance, s, name};
  };
  constexpr double kStep = 0.1;  // m
  const int count = static_cast<int>(std::ceil(path.length() / kStep));
  for (int i = 0; i <= count; ++i) {
    const double s = std::min(path.length(), i * kStep);
    const PathPoint axle = path.at(s);
    const Polygon outline = outlineOf(car, axle);
    for (const Eigen::Vector2d& corner : outline) {
      note(insideOutline(garage.outline, corner), s, "the outer wall");
    }
    for (const Obstacle& obstacle : obstacles) {
      if ((obstacle.center - axle.position).norm() > obstacle.radius + reach) continue;
      note(gapBetween(outline, obstacle.polygon), s, obstacle.name);
    }
  }
  return nearest;
}

}  // namespace parkade::sim
