// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/way.hpp"

#include <fmt/core.h>

#include <cmath>
#include <optional>

#include "parkade/core/check.hpp"
#include "parkade/sim/drive/lane.hpp"

namespace parkade::sim {
namespace {

constexpr double kParkingBlend = 2.0;     // m over which the steering turns while parking
constexpr double kPassBeyond = 0.8;       // m driven on beyond where the reversing corner starts
constexpr double kRearGap = 0.3;          // m left behind a parked car
constexpr double kReverseStraight = 4.0;  // m reversed straight into a side aisle

const AisleGraph::Edge* edgeBetween(const AisleGraph& graph, int a, int b) {
  for (const AisleGraph::Edge& edge : graph.edges) {
    if ((edge.from == a && edge.to == b) || (edge.from == b && edge.to == a)) return &edge;
  }
  return nullptr;
}

std::vector<LaneSegment> segmentsOf(const AisleGraph& graph, const std::vector<int>& nodes) {
  std::vector<LaneSegment> segments;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const AisleGraph::Edge* edge = edgeBetween(graph, nodes[i], nodes[i + 1]);
    PARKADE_CHECK(edge != nullptr, "no aisle between nodes {} and {}", nodes[i], nodes[i + 1]);
    segments.push_back(
        {graph.nodes.at(nodes[i]), graph.nodes.at(nodes[i + 1]), edge->width, edge->one_way});
  }
  PARKADE_CHECK(!segments.empty(), "a way needs two nodes");
  return segments;
}

Eigen::Vector2d directionOf(const LaneSegment& segment) {
  return (segment.to - segment.from).normalized();
}

Status trim(std::vector<LaneSegment>& segments, double start, double end) {
  const auto length = [](const LaneSegment& s) { return (s.to - s.from).norm(); };
  constexpr double kShortest = 2.0;
  if (length(segments.front()) < start + kShortest || length(segments.back()) < end + kShortest) {
    return Error{"the first or last aisle of the way is too short"};
  }
  segments.front().from += start * directionOf(segments.front());
  segments.back().to -= end * directionOf(segments.back());
  return {};
}

// Distance from the vertex at which a rounded right angle starts.
double reach(const CornerOptions& corners) {
  return corners.radius + 0.55 * corners.blend;
}

CornerOptions parkingCorners(double radius) {
  return {radius, radius, kParkingBlend, kParkingBlend};
}

// Passes the side aisle, reverses into it, and drives back.
std::vector<PathLeg> turnRound(const Way& way, const Garage& garage,
                               std::vector<LaneSegment> segments, double radius, Random& random) {
  const AisleGraph& graph = garage.aisles;
  const LaneOptions lane;
  const CornerOptions corners = parkingCorners(radius);
  const Eigen::Vector2d node = graph.nodes.at(way.nodes.back());
  const Eigen::Vector2d along = directionOf(segments.back());
  const Eigen::Vector2d side = (graph.nodes.at(way.reverse_into) - node).normalized();
  LaneSegment beyond = segments.back();
  beyond.from = node;
  beyond.to = node + (reach(corners) + kPassBeyond) * along;
  segments.push_back(beyond);
  PathLeg out;
  out.vertices = laneVertices(segments, lane, random);
  // The line that the car is on crosses the side aisle's centre line here.
  const Eigen::Vector2d stop = out.vertices.back();
  const Eigen::Vector2d vertex = stop - (stop - node).dot(along) * along;
  PathLeg reverse;
  reverse.reverse = true;
  reverse.corners = corners;
  const Eigen::Vector2d end = node + (reach(corners) + lane.offset + kReverseStraight) * side;
  reverse.vertices = {stop, vertex, end};
  std::vector<LaneSegment> back{{end, node, beyond.width, false}};
  std::vector<LaneSegment> rest = segmentsOf(graph, way.back);
  rest.back().to -= way.trim_end * directionOf(rest.back());
  back.insert(back.end(), rest.begin(), rest.end());
  PathLeg home;
  home.vertices = laneVertices(back, lane, random, 0.0);
  return {out, reverse, home};
}

// Stops beyond the slot and reverses into it.
std::vector<PathLeg> park(const Way& way, const Garage& garage, std::vector<LaneSegment> segments,
                          const VehicleShape& car, const ParkingStyle& style, Random& random) {
  const Slot& slot = garage.slots.at(way.park_in);
  const CornerOptions corners = parkingCorners(style.radius);
  const Eigen::Vector2d entrance = 0.5 * (slot.corners[0] + slot.corners[1]);
  const Eigen::Vector2d rear = 0.5 * (slot.corners[2] + slot.corners[3]);
  const Eigen::Vector2d into = (rear - entrance).normalized();
  LaneSegment& last = segments.back();
  const Eigen::Vector2d along = directionOf(last);
  const Eigen::Vector2d right(along.y(), -along.x());
  const double passed = (entrance - last.from).dot(along);
  last.to = last.from + (passed + reach(corners) + kPassBeyond) * along;
  const double offset = into.dot(right) > 0.0 ? -style.aisle_offset : style.aisle_offset;
  PathLeg out;
  out.vertices = laneVertices(segments, {}, random, std::nullopt, offset);
  const Eigen::Vector2d stop = out.vertices.back();
  const Eigen::Vector2d vertex = stop - (stop - entrance).dot(along) * along;
  PathLeg reverse;
  reverse.reverse = true;
  reverse.corners = corners;
  reverse.vertices = {stop, vertex, rear - (car.rear_overhang + kRearGap) * into};
  return {out, reverse};
}

}  // namespace

Result<Path> pathAlong(const Way& way, const Garage& garage, const VehicleShape& car,
                       const ParkingStyle& parking, Random random) {
  std::vector<LaneSegment> segments = segmentsOf(garage.aisles, way.nodes);
  const bool plain = way.park_in < 0 && way.reverse_into < 0;
  const Status trimmed = trim(segments, way.trim_start, plain ? way.trim_end : 0.0);
  if (!trimmed) return trimmed.error();
  if (way.park_in >= 0) return buildPath(park(way, garage, segments, car, parking, random));
  if (way.reverse_into >= 0) {
    return buildPath(turnRound(way, garage, segments, parking.radius, random));
  }
  PathLeg leg;
  leg.vertices = laneVertices(segments, {}, random);
  return buildPath({leg});
}

std::vector<int> slotsBeside(const Garage& garage, int from, int to) {
  const AisleGraph::Edge* edge = edgeBetween(garage.aisles, from, to);
  PARKADE_CHECK(edge != nullptr, "no aisle between nodes {} and {}", from, to);
  const Eigen::Vector2d a = garage.aisles.nodes.at(from);
  const Eigen::Vector2d d = garage.aisles.nodes.at(to) - a;
  const Eigen::Vector2d along = d.normalized();
  std::vector<int> found;
  for (std::size_t i = 0; i < garage.slots.size(); ++i) {
    const Slot& slot = garage.slots[i];
    const Eigen::Vector2d entrance = 0.5 * (slot.corners[0] + slot.corners[1]);
    const Eigen::Vector2d into =
        (0.5 * (slot.corners[2] + slot.corners[3]) - entrance).normalized();
    const double at = (entrance - a).dot(along);
    const double beside = (entrance - a - at * along).norm();
    constexpr double kSlack = 0.5;  // m
    if (slot.type == SlotType::kPerpendicular && std::abs(into.dot(along)) < 0.05 && at > 0.0 &&
        at < d.norm() && std::abs(beside - 0.5 * edge->width) < kSlack) {
      found.push_back(static_cast<int>(i));
    }
  }
  return found;
}

}  // namespace parkade::sim
