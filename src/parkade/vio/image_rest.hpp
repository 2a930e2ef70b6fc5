// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "parkade/vio/options.hpp"
#include "parkade/vio/window.hpp"

namespace parkade {

/// Whether the pictures stand still between two frame sets; nothing where too few features are in
/// both. Two tests, and motion by either is motion:
/// - the median length of the displacements, all cameras together, is more than
///   max_disparity_px and the features' own noise: flow that spreads from a point;
/// - in most cameras the median displacement is more than max_shift_px and three times its
///   standard error, taken from how much the displacements differ: a slow roll, which shifts many
///   features by little, all alike. What moves before a single camera does not count.
std::optional<bool> imagesAtRest(const Observations& before, const Observations& now,
                                 const VioStandstillOptions& options);

}  // namespace parkade
