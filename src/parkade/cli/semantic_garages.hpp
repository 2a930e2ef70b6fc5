// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/sim/drive/spec.hpp"

namespace parkade::cli {

/// Garage seeds 0 to 4999 are for training, 5000 to 5999 for scores.
inline constexpr int kFirstTestSeed = 5000;

/// Seeds of "random:N" (N of them from the first test seed on), or "random:FIRST-LAST"; at most
/// 100,000.
Result<std::vector<int>> parseGarages(const std::string& text);

/// The conditions of a garage's drive, drawn from its seed: 10 to 1000 lux (even in the logarithm),
/// 20 to 95 % occupied, moving cars and people, and a rig of its own: avp6 or avm4 with every
/// camera turned, moved and refocused a little. The rig's file goes to DIR/rigs.
Result<sim::SimSpec> drawConditions(int garage_seed, const std::string& folder);

}  // namespace parkade::cli
