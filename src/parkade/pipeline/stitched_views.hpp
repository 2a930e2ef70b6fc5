// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/bev/stitcher.hpp"
#include "parkade/camera/rig.hpp"
#include "parkade/semantics/bev_views.hpp"

namespace parkade {

/// Which camera each pixel of the stitcher's pictures is mostly of: the one with the largest
/// weight, of those that are present (by camera; more than given: are). Set the stitcher's masks
/// before.
BevViews viewsOf(const BevStitcher& stitcher, const Rig& rig,
                 const std::vector<bool>& present = {});

}  // namespace parkade
