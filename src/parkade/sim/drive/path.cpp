// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/path.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parkade/core/check.hpp"
#include "parkade/geometry/so3.hpp"

namespace parkade::sim {
namespace {

constexpr double kNodeSpacing = 0.05;  // m; Simpson's rule over it errs by less than 1e-11 m
constexpr double kStraight = 1e-6;     // rad; smaller corners are none

// The quintic step 0..1 over 0..1 and its integral.
double step(double x) {
  return x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
}
double stepIntegral(double x) {
  return x * x * x * x * (2.5 + x * (-3.0 + x));
}

double curvatureAt(const PathElement& element, double u) {
  if (element.length <= 0.0) return element.end_curvature;
  return element.start_curvature +
         (element.end_curvature - element.start_curvature) * step(u / element.length);
}

double headingChange(const PathElement& element, double u) {
  if (element.length <= 0.0) return 0.0;
  const double turn =
      element.start_curvature * u + (element.end_curvature - element.start_curvature) *
                                        element.length * stepIntegral(u / element.length);
  return element.direction * turn;
}

Eigen::Vector2d unit(double heading) {
  return {std::cos(heading), std::sin(heading)};
}

// A rounded corner: blend in, arc, blend out.
struct Corner {
  double turn = 0.0;  // rad, signed, of the direction of motion
  double radius = 0.0;
  double blend = 0.0;
  double setback = 0.0;  // m from the vertex to both ends
  double curvature = 0.0;
  double arc = 0.0;
};

void shapeCorner(Corner& corner) {
  const double turn = std::abs(corner.turn);
  if (turn < kStraight) {
    corner.setback = corner.arc = corner.curvature = 0.0;
    return;
  }
  corner.arc = turn * corner.radius - corner.blend;
  corner.curvature = 1.0 / corner.radius;
  if (corner.arc < 0.0) {  // too little to turn: the wished radius is never reached
    corner.arc = 0.0;
    corner.curvature = turn / corner.blend;
  }
  const Path path(Eigen::Vector2d::Zero(), 0.0,
                  {{corner.blend, 0.0, corner.curvature, 1},
                   {corner.arc, corner.curvature, corner.curvature, 1},
                   {corner.blend, corner.curvature, 0.0, 1}});
  // The end lies on the outgoing line as far from the vertex as the start.
  corner.setback = path.at(path.length()).position.x() / (1.0 + std::cos(turn));
}

// Makes a corner need less space; false where it is as tight as allowed.
bool tighten(Corner& corner, const CornerOptions& options) {
  if (std::abs(corner.turn) < kStraight) return false;
  if (corner.radius > options.min_radius) {
    corner.radius = std::max(options.min_radius, corner.radius * 0.95);
  } else if (corner.blend > options.min_blend) {
    corner.blend = std::max(options.min_blend, corner.blend * 0.9);
  } else {
    return false;
  }
  shapeCorner(corner);
  return true;
}

Result<std::vector<Corner>> fitCorners(const PathLeg& leg) {
  const std::size_t count = leg.vertices.size();
  std::vector<Corner> corners(count);
  std::vector<double> lengths;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    lengths.push_back((leg.vertices[i + 1] - leg.vertices[i]).norm());
    PARKADE_CHECK(lengths.back() > 1e-6, "path vertices {} and {} coincide", i, i + 1);
  }
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const Eigen::Vector2d in = leg.vertices[i] - leg.vertices[i - 1];
    const Eigen::Vector2d out = leg.vertices[i + 1] - leg.vertices[i];
    corners[i].turn = wrapAngle(std::atan2(out.y(), out.x()) - std::atan2(in.y(), in.x()));
    corners[i].radius = leg.corners.radius;
    corners[i].blend = leg.corners.blend;
    shapeCorner(corners[i]);
  }
  for (std::size_t i = 0; i + 1 < count; ++i) {
    while (corners[i].setback + corners[i + 1].setback > lengths[i]) {
      const bool first_larger = corners[i].setback > corners[i + 1].setback;
      Corner& larger = first_larger ? corners[i] : corners[i + 1];
      Corner& smaller = first_larger ? corners[i + 1] : corners[i];
      if (!tighten(larger, leg.corners) && !tighten(smaller, leg.corners)) {
        return Error{fmt::format(
            "the way from ({:.1f}, {:.1f}) to ({:.1f}, {:.1f}) is too short for its corners: "
            "{:.1f} m, the car needs {:.1f} m",
            leg.vertices[i].x(), leg.vertices[i].y(), leg.vertices[i + 1].x(),
            leg.vertices[i + 1].y(), lengths[i], corners[i].setback + corners[i + 1].setback)};
      }
    }
  }
  return corners;
}

void appendLeg(const PathLeg& leg, const std::vector<Corner>& corners,
               std::vector<PathElement>& elements) {
  const int direction = leg.reverse ? -1 : 1;
  for (std::size_t i = 0; i + 1 < leg.vertices.size(); ++i) {
    const double length = (leg.vertices[i + 1] - leg.vertices[i]).norm();
    elements.push_back({length - corners[i].setback - corners[i + 1].setback, 0.0, 0.0, direction});
    const Corner& corner = corners[i + 1];
    if (corner.curvature == 0.0) continue;
    // Turning left while moving backwards means a curvature to the right.
    const double k = std::copysign(corner.curvature, corner.turn * direction);
    elements.push_back({corner.blend, 0.0, k, direction});
    elements.push_back({corner.arc, k, k, direction});
    elements.push_back({corner.blend, k, 0.0, direction});
  }
}

}  // namespace

Path::Path(const Eigen::Vector2d& start, double heading, std::vector<PathElement> elements) {
  for (const PathElement& element : elements) {
    if (element.length > 0.0) elements_.push_back(element);
  }
  PARKADE_CHECK(!elements_.empty(), "a path needs an element with a length");
  Node node{0.0, start, heading, 0};
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const PathElement& element = elements_[e];
    if (e > 0 && element.direction != elements_[e - 1].direction) {
      PARKADE_CHECK(element.start_curvature == 0.0 && elements_[e - 1].end_curvature == 0.0,
                    "the wheels must stand straight where the direction changes");
      gear_changes_.push_back(length_);
    }
    element_start_.push_back(length_);
    element_heading_.push_back(node.heading);
    node.element = e;
    const int steps = std::max(1, static_cast<int>(std::ceil(element.length / kNodeSpacing)));
    for (int i = 1; i <= steps; ++i) {
      nodes_.push_back(node);
      const double s = element_start_[e] + element.length * i / steps;
      const PathPoint next = advance(node, s);
      node = {s, next.position, next.heading, e};
    }
    length_ += element.length;
    node.s = length_;
  }
}

PathPoint Path::advance(const Node& node, double s) const {
  const PathElement& element = elements_[node.element];
  const double start = element_start_[node.element];
  const double heading0 = element_heading_[node.element];
  const auto direction_at = [&](double at) { return unit(heading0 + headingChange(element, at)); };
  const double u0 = node.s - start;
  const double u1 = s - start;
  PathPoint point;
  point.direction = element.direction;
  point.heading = heading0 + headingChange(element, u1);
  point.curvature = curvatureAt(element, u1);
  point.position = node.position + element.direction * (u1 - u0) / 6.0 *
                                       (direction_at(u0) + 4.0 * direction_at(0.5 * (u0 + u1)) +
                                        unit(point.heading));
  return point;
}

PathPoint Path::at(double s) const {
  PARKADE_CHECK(!nodes_.empty(), "an empty path has no points");
  const double clamped = std::clamp(s, 0.0, length_);
  const auto next = std::upper_bound(nodes_.begin() + 1, nodes_.end(), clamped,
                                     [](double value, const Node& node) { return value < node.s; });
  return advance(*(next - 1), clamped);
}

double Path::maxCurvature() const {
  double most = 0.0;
  for (const PathElement& element : elements_) {
    most = std::max({most, std::abs(element.start_curvature), std::abs(element.end_curvature)});
  }
  return most;
}

Result<Path> buildPath(const std::vector<PathLeg>& legs) {
  PARKADE_CHECK(!legs.empty(), "a path needs a leg");
  std::vector<PathElement> elements;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    PARKADE_CHECK(legs[i].vertices.size() >= 2, "leg {} has {} vertices", i,
                  legs[i].vertices.size());
    if (i > 0) {
      PARKADE_CHECK((legs[i].vertices.front() - legs[i - 1].vertices.back()).norm() < 1e-9,
                    "leg {} starts elsewhere than leg {} ends", i, i - 1);
    }
    const Result<std::vector<Corner>> corners = fitCorners(legs[i]);
    if (!corners) return corners.error();
    appendLeg(legs[i], *corners, elements);
  }
  const Eigen::Vector2d first = legs[0].vertices[1] - legs[0].vertices[0];
  double heading = std::atan2(first.y(), first.x());
  if (legs[0].reverse) heading = wrapAngle(heading + std::numbers::pi);
  return Path(legs[0].vertices[0], heading, std::move(elements));
}

}  // namespace parkade::sim
