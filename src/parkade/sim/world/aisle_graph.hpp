// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/sim/garage.hpp"

namespace parkade::sim {

/// Nodes that a car can go to from a node.
std::vector<int> neighboursOf(const AisleGraph& graph, int node);

/// Which way a car that came from `before` turns at `node` to go on to `next`: straight, left,
/// right or back.
std::string turnTo(const AisleGraph& graph, int before, int node, int next);

/// All ways on for a car that came from `before`, as an arrow's meaning: "straight_left", "left",
/// ...; empty where there is none.
std::string turnsAt(const AisleGraph& graph, int before, int node);

/// For each node the next one on the shortest way to `goal`; -1 at the goal.
std::vector<int> nextTowards(const AisleGraph& graph, int goal);

}  // namespace parkade::sim
