// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/types/bev_image.hpp"

namespace parkade {

/// The picture at another scale, about the same middle: pixels are averaged where it becomes
/// coarser. Its sides are rounded to whole pixels, metres_per_px (positive) is therefore met to
/// half a pixel over the picture's width. valid: where any part of a pixel is.
BevImage rescaled(const BevImage& bev, double metres_per_px);

}  // namespace parkade
