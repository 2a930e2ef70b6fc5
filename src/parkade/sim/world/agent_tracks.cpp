// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/agent_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "parkade/sim/drive/lane.hpp"
#include "parkade/sim/drive/path.hpp"
#include "parkade/sim/world/aisle_graph.hpp"

namespace parkade::sim {
namespace {

AgentTrack trackOf(const Path& path, double middle) {
  AgentTrack track;
  const int count = static_cast<int>(path.length() / AgentTrack::kSpacing);
  for (int i = 0; i <= count; ++i) {
    const PathPoint axle = path.at(i * AgentTrack::kSpacing);
    track.poses.emplace_back(axle.position.x() + middle * std::cos(axle.heading),
                             axle.position.y() + middle * std::sin(axle.heading), axle.heading);
  }
  return track;
}

// Rounds a polyline by averaging over a walked metre, and turns it into a track.
AgentTrack walkingTrack(const std::vector<Eigen::Vector2d>& corners) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d step = corners[i + 1] - corners[i];
    const int count = std::max(1, static_cast<int>(step.norm() / AgentTrack::kSpacing));
    for (int k = 0; k < count; ++k) points.emplace_back(corners[i] + k * step / count);
  }
  points.push_back(corners.back());
  constexpr int kHalfWindow = 5;
  const int last = static_cast<int>(points.size()) - 1;
  std::vector<Eigen::Vector2d> smooth;
  for (int i = 0; i <= last; ++i) {
    // A window that shrinks towards the ends keeps them where they are.
    const int half = std::min({kHalfWindow, i, last - i});
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int k = -half; k <= half; ++k) sum += points[static_cast<std::size_t>(i + k)];
    smooth.emplace_back(sum / (2.0 * half + 1.0));
  }
  AgentTrack track;
  double yaw = 0.0;
  for (int i = 0; i <= last; ++i) {
    const Eigen::Vector2d along = smooth[static_cast<std::size_t>(std::min(i + 2, last))] -
                                  smooth[static_cast<std::size_t>(std::max(i - 2, 0))];
    const double heading = std::atan2(along.y(), along.x());
    yaw = i == 0 ? heading : yaw + wrapAngle(heading - yaw);
    const Eigen::Vector2d& p = smooth[static_cast<std::size_t>(i)];
    track.poses.emplace_back(p.x(), p.y(), yaw);
  }
  return track;
}

}  // namespace

std::optional<AgentTrack> carTrack(const Garage& garage, double middle, double length,
                                   Random& random) {
  const AisleGraph& graph = garage.aisles;
  std::vector<int> nodes = {static_cast<int>(random.index(graph.nodes.size()))};
  double total = 0.0;
  while (total < length && nodes.size() < 60) {
    std::vector<int> choices;
    for (const int next : neighboursOf(graph, nodes.back())) {
      if (nodes.size() < 2 || next != nodes[nodes.size() - 2]) choices.push_back(next);
    }
    if (choices.empty()) break;
    nodes.push_back(random.pick(choices));
    total += (graph.nodes[static_cast<std::size_t>(nodes.back())] -
              graph.nodes[static_cast<std::size_t>(nodes[nodes.size() - 2])])
                 .norm();
  }
  std::vector<LaneSegment> segments;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    LaneSegment segment;
    segment.from = graph.nodes[static_cast<std::size_t>(nodes[i])];
    segment.to = graph.nodes[static_cast<std::size_t>(nodes[i + 1])];
    for (const AisleGraph::Edge& edge : graph.edges) {
      if ((edge.from == nodes[i] && edge.to == nodes[i + 1]) ||
          (edge.to == nodes[i] && edge.from == nodes[i + 1])) {
        segment.width = edge.width;
        segment.one_way = edge.one_way;
      }
    }
    segments.push_back(segment);
  }
  if (segments.empty()) return std::nullopt;
  LaneOptions lane;
  lane.offset = 1.55;
  lane.right_turn_offset = 0.9;
  lane.wander = 0.05;
  PathLeg leg;
  leg.vertices = laneVertices(segments, lane, random);
  leg.corners.radius = 5.5;
  leg.corners.min_radius = 4.5;
  leg.corners.blend = 2.5;
  const Result<Path> path = buildPath({leg});
  if (!path || path->length() < 5.0) return std::nullopt;
  return trackOf(*path, middle);
}

std::optional<AgentTrack> personTrack(const Garage& garage,
                                      const std::optional<Eigen::Vector2d>& near, Random& random) {
  const AisleGraph& graph = garage.aisles;
  if (graph.edges.empty()) return std::nullopt;
  const AisleGraph::Edge* edge = &random.pick(graph.edges);
  double share = random.uniform(0.25, 0.75);
  const auto node = [&](int i) -> const Eigen::Vector2d& {
    return graph.nodes[static_cast<std::size_t>(i)];
  };
  if (near) {
    double best = std::numeric_limits<double>::max();
    for (const AisleGraph::Edge& one : graph.edges) {
      const Eigen::Vector2d along = node(one.to) - node(one.from);
      const double u =
          std::clamp((*near - node(one.from)).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double distance = (node(one.from) + u * along - *near).norm();
      if (distance < best) {
        best = distance;
        edge = &one;
        share = std::clamp(u, 0.1, 0.9);
      }
    }
  }
  const Eigen::Vector2d a = node(edge->from);
  const Eigen::Vector2d b = node(edge->to);
  const double length = (b - a).norm();
  if (length < 12.0) return std::nullopt;
  Eigen::Vector2d along = (b - a) / length;
  if (random.chance(0.5)) along = -along;
  const Eigen::Vector2d left(-along.y(), along.x());
  const double side = (random.chance(0.5) ? 1.0 : -1.0) * (0.5 * edge->width - 0.45);
  const Eigen::Vector2d crossing = a + share * (b - a);
  // Stay clear of the crossings of aisles at both ends.
  const auto room = [&](const Eigen::Vector2d& direction) {
    return std::max(
        1.0, (direction.dot(b - a) > 0.0 ? (b - crossing).norm() : (crossing - a).norm()) - 4.0);
  };
  const double before = std::min(random.uniform(2.0, 14.0), room(-along));
  const double after = std::min(random.uniform(3.0, 25.0), room(along));
  return walkingTrack({crossing - before * along + side * left, crossing + side * left,
                       crossing - side * left + 0.6 * along,
                       crossing - side * left + after * along});
}

bool hitsStanding(const AgentTrack& track, const Eigen::Vector2d& half, const Garage& garage) {
  constexpr double kClear = 0.15;
  for (std::size_t i = 0; i < track.poses.size(); i += 2) {
    const Eigen::Vector3d& pose = track.poses[i];
    const auto touches = [&](const Eigen::Vector2d& center, const Eigen::Vector2d& other,
                             double yaw) {
      const Eigen::Vector3d box(center.x(), center.y(), yaw);
      const double far = half.norm() + other.norm() + kClear;
      return (center - pose.head<2>()).squaredNorm() < far * far &&
             boxDistance(pose, half, box, other) < kClear;
    };
    for (const Pillar& pillar : garage.pillars) {
      if (touches(pillar.center, 0.5 * pillar.size, 0.0)) return true;
    }
    for (const Room& room : garage.rooms) {
      if (touches(0.5 * (room.min + room.max), 0.5 * (room.max - room.min), 0.0)) return true;
    }
    for (const Slot& slot : garage.slots) {
      if (!slot.occupied) continue;
      const Eigen::Vector2d axis = slot.corners[3] - slot.corners[0];
      const Eigen::Vector2d center =
          0.25 * (slot.corners[0] + slot.corners[1] + slot.corners[2] + slot.corners[3]);
      if (touches(center, {0.5 * axis.norm() - 0.1, 0.95}, std::atan2(axis.y(), axis.x())))
        return true;
    }
  }
  return false;
}

}  // namespace parkade::sim
