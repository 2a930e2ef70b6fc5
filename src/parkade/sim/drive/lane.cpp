// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/lane.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/geometry/planar.hpp"

namespace parkade::sim {
namespace {

constexpr double kStraightOn = 0.05;  // rad; smaller turns are none
constexpr double kRightTurn = -0.35;  // rad; from here on the driver swings out
constexpr double kRoomBeside = 1.6;   // m that the car's middle keeps from the aisle's edge

struct Stretch {
  Eigen::Vector2d from, to;
  Eigen::Vector2d along, right;
  double length = 0.0;
  double middle = 0.0;  // offsets, m right of the centre
  double start = 0.0;
  double end = 0.0;
};

double turnBetween(const Stretch& in, const Stretch& out) {
  return std::atan2(cross(in.along, out.along), in.along.dot(out.along));
}

Stretch makeStretch(const LaneSegment& segment, const LaneOptions& options) {
  Stretch stretch;
  stretch.from = segment.from;
  stretch.to = segment.to;
  stretch.length = (segment.to - segment.from).norm();
  PARKADE_CHECK(stretch.length > 1e-6, "a lane segment without length");
  stretch.along = (segment.to - segment.from) / stretch.length;
  stretch.right = {stretch.along.y(), -stretch.along.x()};
  const double most = std::max(0.0, 0.5 * segment.width - kRoomBeside);
  stretch.middle = segment.one_way ? 0.0 : std::min(options.offset, most);
  stretch.start = stretch.end = stretch.middle;
  return stretch;
}

std::vector<Stretch> join(const std::vector<LaneSegment>& segments, const LaneOptions& options) {
  std::vector<Stretch> stretches;
  for (const LaneSegment& segment : segments) {
    const Stretch next = makeStretch(segment, options);
    if (!stretches.empty() && std::abs(turnBetween(stretches.back(), next)) < kStraightOn &&
        stretches.back().middle == next.middle) {
      stretches.back().to = next.to;
      stretches.back().length += next.length;
    } else {
      stretches.push_back(next);
    }
  }
  return stretches;
}

// A place beside the centre line.
struct Knot {
  double at = 0.0;  // m along
  double offset = 0.0;
};

// Changes of offset along one stretch, between its corners.
std::vector<Knot> knotsOf(Stretch& stretch, bool corner_before, bool corner_after,
                          const LaneOptions& options, Random& random) {
  const double first = corner_before ? options.corner_zone : 0.5;
  const double last = stretch.length - (corner_after ? options.corner_zone : 0.5);
  const bool shift_in = std::abs(stretch.start - stretch.middle) > 1e-9;
  const bool shift_out = std::abs(stretch.end - stretch.middle) > 1e-9;
  const double need =
      (shift_in ? options.shift_length : 0.0) + (shift_out ? options.shift_length : 0.0);
  std::vector<Knot> knots;
  if (last - first < need) {
    if (std::abs(stretch.start - stretch.end) > 1e-9 && last - first >= options.shift_length) {
      knots = {{first, stretch.start}, {last, stretch.end}};
    }
    return knots;
  }
  double begin = first;
  double end = last;
  if (shift_in) {
    begin += options.shift_length;
    knots.push_back({first, stretch.start});
    knots.push_back({begin, stretch.middle});
  }
  if (shift_out) end -= options.shift_length;
  const int count = static_cast<int>((end - begin) / options.wander_spacing) - 1;
  for (int i = 1; i <= count; ++i) {
    const double drift = std::clamp(random.normal(), -2.0, 2.0) * options.wander;
    knots.push_back({begin + (end - begin) * i / (count + 1), stretch.middle + drift});
  }
  if (shift_out) {
    knots.push_back({end, stretch.middle});
    knots.push_back({last, stretch.end});
  }
  return knots;
}

}  // namespace

std::vector<Eigen::Vector2d> laneVertices(std::vector<LaneSegment> segments,
                                          const LaneOptions& options, Random& random,
                                          std::optional<double> start_offset,
                                          std::optional<double> end_offset) {
  PARKADE_CHECK(!segments.empty(), "a lane needs a segment");
  std::vector<Stretch> stretches = join(segments, options);
  const std::size_t count = stretches.size();
  for (std::size_t i = 0; i + 1 < count; ++i) {
    if (turnBetween(stretches[i], stretches[i + 1]) < kRightTurn) {
      stretches[i].end = std::min(stretches[i].middle, options.right_turn_offset);
      stretches[i + 1].start = std::min(stretches[i + 1].middle, options.right_turn_offset);
    }
  }
  if (start_offset) stretches.front().start = *start_offset;
  if (end_offset) stretches.back().end = *end_offset;
  // Where a stretch is too short to change the offset, it keeps the one nearer to the centre.
  for (std::size_t i = 0; i < count; ++i) {
    Stretch& stretch = stretches[i];
    const double zones =
        (i > 0 ? options.corner_zone : 0.5) + (i + 1 < count ? options.corner_zone : 0.5);
    if (stretch.length - zones < options.shift_length) {
      const bool start_nearer = std::abs(stretch.start) < std::abs(stretch.end);
      const bool start_fixed = i == 0 && start_offset.has_value();
      const bool end_fixed = i + 1 == count && end_offset.has_value();
      const double offset = start_fixed                  ? stretch.start
                            : end_fixed || !start_nearer ? stretch.end
                                                         : stretch.start;
      stretch.start = stretch.end = offset;
    }
  }
  std::vector<Eigen::Vector2d> vertices;
  const auto beside = [](const Stretch& stretch, double at, double offset) {
    return Eigen::Vector2d(stretch.from + at * stretch.along + offset * stretch.right);
  };
  vertices.push_back(beside(stretches.front(), 0.0, stretches.front().start));
  for (std::size_t i = 0; i < count; ++i) {
    Stretch& stretch = stretches[i];
    for (const Knot& knot : knotsOf(stretch, i > 0, i + 1 < count, options, random)) {
      vertices.push_back(beside(stretch, knot.at, knot.offset));
    }
    if (i + 1 == count) break;
    // The corner is where both offset lines cross.
    const Stretch& next = stretches[i + 1];
    const Eigen::Vector2d p = beside(stretch, stretch.length, stretch.end);
    const Eigen::Vector2d q = beside(next, 0.0, next.start);
    const double sine = cross(stretch.along, next.along);
    vertices.push_back(std::abs(sine) < 0.02
                           ? Eigen::Vector2d(0.5 * (p + q))
                           : Eigen::Vector2d(p + cross(q - p, next.along) / sine * stretch.along));
  }
  vertices.push_back(beside(stretches.back(), stretches.back().length, stretches.back().end));
  return vertices;
}

}  // namespace parkade::sim
