// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/aisle_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/geometry/so3.hpp"

namespace parkade::sim {

std::vector<int> neighboursOf(const AisleGraph& graph, int node) {
  std::vector<int> out;
  for (const AisleGraph::Edge& edge : graph.edges) {
    if (edge.from == node) out.push_back(edge.to);
    if (edge.to == node && !edge.one_way) out.push_back(edge.from);
  }
  return out;
}

std::string turnTo(const AisleGraph& graph, int before, int node, int next) {
  const auto at = [&](int i) { return graph.nodes[static_cast<std::size_t>(i)]; };
  const Eigen::Vector2d in = at(node) - at(before);
  const Eigen::Vector2d out = at(next) - at(node);
  const double turn = wrapAngle(std::atan2(out.y(), out.x()) - std::atan2(in.y(), in.x()));
  if (std::abs(turn) < M_PI_4) return "straight";
  if (std::abs(turn) > 3.0 * M_PI_4) return "back";
  return turn > 0.0 ? "left" : "right";
}

std::string turnsAt(const AisleGraph& graph, int before, int node) {
  bool straight = false;
  bool left = false;
  bool right = false;
  for (const int next : neighboursOf(graph, node)) {
    if (next == before) continue;
    const std::string turn = turnTo(graph, before, node, next);
    straight |= turn == "straight";
    left |= turn == "left";
    right |= turn == "right";
  }
  std::string meaning;
  const auto add = [&](bool there, const char* word) {
    if (there) meaning += (meaning.empty() ? "" : "_") + std::string(word);
  };
  add(straight, "straight");
  add(left, "left");
  add(right, "right");
  return meaning;
}

std::vector<int> nextTowards(const AisleGraph& graph, int goal) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> distance(graph.nodes.size(), kFar);
  std::vector<int> next(graph.nodes.size(), -1);
  distance[static_cast<std::size_t>(goal)] = 0.0;
  // Bellman and Ford: garages have a few dozen nodes.
  for (std::size_t round = 0; round < graph.nodes.size(); ++round) {
    for (const AisleGraph::Edge& edge : graph.edges) {
      const auto a = static_cast<std::size_t>(edge.from);
      const auto b = static_cast<std::size_t>(edge.to);
      const double length = (graph.nodes[a] - graph.nodes[b]).norm();
      if (distance[b] + length < distance[a] - 1e-9) {
        distance[a] = distance[b] + length;
        next[a] = edge.to;
      }
      if (!edge.one_way && distance[a] + length < distance[b] - 1e-9) {
        distance[b] = distance[a] + length;
        next[b] = edge.from;
      }
    }
  }
  return next;
}

}  // namespace parkade::sim
