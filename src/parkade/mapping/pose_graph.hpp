// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/mapping/parking_map.hpp"

namespace parkade {

struct PoseGraphResult {
  bool usable = false;  ///< poses were found; else nothing was changed
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
};

/// Moves the nodes to where all edges agree best:
/// sum over edges of rho(|W log-like(T_from_to^-1 T_from^-1 T_to)|^2) with W'W the edge's
/// information, order (translation, rotation); the rotation's part is twice the quaternion's vector
/// part. rho is Cauchy's with this scale for loops (a wrong one must not bend the map) and none
/// for odometry. The first node stays. Edges whose information is singular bind only the directions
/// that it knows; edges that name unknown nodes are left out. One thread: the same bytes always.
PoseGraphResult optimisePoseGraph(std::vector<PoseGraphNode>& nodes,
                                  const std::vector<PoseGraphEdge>& edges, double loop_scale = 2.0);

}  // namespace parkade
