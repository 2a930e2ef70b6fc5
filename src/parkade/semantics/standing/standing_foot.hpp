// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/semantics/bev_views.hpp"
#include "parkade/semantics/markings/marking_pieces.hpp"

namespace parkade {

/// What of a low, long thing that stands on the floor (a wheel stop) lies on it. A stitched picture
/// smears such a thing away from its camera: its own place runs along the near edge, `depth` metres
/// wide. What hides the floor behind the smear does not cut it.
MarkingPiece footOf(const MarkingPiece& piece, const BevViews& views, const BevGeometry& geometry,
                    double depth);

}  // namespace parkade
