// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/sim/garage.hpp"

namespace parkade::cli {

/// Middle of the box around some of a marking's polygons along its own axes, in the garage's
/// frame. Of an arrow, whose head may lie to one side, on the line of its shaft.
Eigen::Vector2d middleOf(const sim::Marking& marking,
                         const std::vector<std::vector<Eigen::Vector2d>>& polygons);

}  // namespace parkade::cli
