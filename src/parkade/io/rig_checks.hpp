// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/io/check.hpp"

namespace parkade {

/// What no car has, though its rig file says so: intrinsics of another picture size, cameras under
/// the ground or far from the car, masks that cannot be read or have another size (kFail).
std::vector<Check> checkRig(const Rig& rig);

}  // namespace parkade
