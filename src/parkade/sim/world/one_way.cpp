// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/one_way.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "parkade/core/check.hpp"

namespace parkade::sim {
namespace {

/// Edges that become one-way together, each with whether against its present direction.
using Stretches = std::vector<std::pair<std::size_t, bool>>;

void direct(const Stretches& stretches, bool against, AisleGraph& graph) {
  for (const auto& [index, turned] : stretches) {
    AisleGraph::Edge& edge = graph.edges[index];
    edge.one_way = true;
    if (turned != against) std::swap(edge.from, edge.to);
  }
}

/// Whether every edge is reached from every other in every permitted direction, without turning
/// back on the spot.
bool allInReach(const AisleGraph& graph) {
  struct Arc {
    int from = 0;
    int to = 0;
    std::size_t edge = 0;
  };
  std::vector<Arc> arcs;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const AisleGraph::Edge& edge = graph.edges[i];
    arcs.push_back({edge.from, edge.to, i});
    if (!edge.one_way) arcs.push_back({edge.to, edge.from, i});
  }
  for (std::size_t start = 0; start < arcs.size(); ++start) {
    std::vector<bool> seen(arcs.size(), false);
    std::vector<bool> reached(graph.edges.size(), false);
    std::size_t count = 0;
    std::vector<std::size_t> todo{start};
    seen[start] = true;
    while (!todo.empty()) {
      const Arc here = arcs[todo.back()];
      todo.pop_back();
      if (!reached[here.edge]) ++count;
      reached[here.edge] = true;
      for (std::size_t i = 0; i < arcs.size(); ++i) {
        if (seen[i] || arcs[i].from != here.to || arcs[i].edge == here.edge) continue;
        seen[i] = true;
        todo.push_back(i);
      }
    }
    if (count < graph.edges.size()) return false;
  }
  return true;
}

/// The edges of every aisle from wall to wall, by where it lies; each in the direction of growing
/// coordinates.
std::map<double, Stretches> aislesAlong(const AisleGraph& graph, int axis) {
  std::map<double, Stretches> aisles;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const Eigen::Vector2d& a = graph.nodes[static_cast<std::size_t>(graph.edges[i].from)];
    const Eigen::Vector2d& b = graph.nodes[static_cast<std::size_t>(graph.edges[i].to)];
    const Eigen::Vector2d d = b - a;
    if (std::abs(d[axis]) > std::abs(d[1 - axis])) {
      aisles[a[1 - axis]].emplace_back(i, d[axis] < 0.0);
    }
  }
  return aisles;
}

void append(const Stretches& aisle, bool against, Stretches& out) {
  for (const auto& [index, turned] : aisle) out.emplace_back(index, turned != against);
}

}  // namespace

void makeOneWay(double share, Random random, AisleGraph& graph) {
  PARKADE_CHECK(share >= 0.0 && share <= 1.0, "a share of {} of the aisles", share);
  std::vector<Stretches> candidates;
  Stretches ring;  // counter-clockwise
  for (const int axis : {0, 1}) {
    const std::map<double, Stretches> aisles = aislesAlong(graph, axis);
    if (aisles.empty()) return;
    for (auto it = aisles.begin(); it != aisles.end(); ++it) {
      if (it == aisles.begin()) {
        append(it->second, axis == 1, ring);
      } else if (std::next(it) == aisles.end()) {
        append(it->second, axis == 0, ring);
      } else {
        candidates.push_back(it->second);
      }
    }
  }
  random.shuffle(candidates);
  candidates.insert(candidates.begin(), ring);
  for (const Stretches& candidate : candidates) {
    const bool wanted = random.chance(share);
    const bool against = random.chance(0.5);
    if (!wanted) continue;
    for (const bool turn : {against, !against}) {
      AisleGraph tried = graph;
      direct(candidate, turn, tried);
      if (!allInReach(tried)) continue;
      graph = std::move(tried);
      break;
    }
  }
}

}  // namespace parkade::sim
