// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/core/random.hpp"
#include "parkade/sim/garage.hpp"

namespace parkade::sim {

/// Makes about a share (0 to 1) of a grid's aisles one-way, whole aisles from wall to wall; the
/// four outer ones become a roundabout together, or none of them. Only where every stretch can
/// still be reached from every other without turning back on the spot. An edge that is one-way
/// leads from its `from` to its `to`: they may change places.
void makeOneWay(double share, Random random, AisleGraph& graph);

}  // namespace parkade::sim
