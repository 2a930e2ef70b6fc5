// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/eval/map_evaluation.hpp"

// The parts of evaluateMap(): not for others.
namespace parkade {

/// Where the vehicle's origin went, in the truth's frame.
using Way = std::vector<Eigen::Vector2d>;

/// m, from a point to the nearest of the way's; infinite where there is none.
double distanceToWay(const Eigen::Vector2d& p, const Way& way);

/// Set result.slots, matches, missed and wrong, by its options and T_truth_map.
void scoreSlots(const ParkingMap& map, const MapTruth& truth, const Way& way,
                MapEvaluation& result);

/// Sets result.objects likewise.
void scoreObjects(const ParkingMap& map, const MapTruth& truth, const Way& way,
                  MapEvaluation& result);

}  // namespace parkade
