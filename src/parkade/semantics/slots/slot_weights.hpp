// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/semantics/slots/slot_clues.hpp"

// Written by tools/train/slot_weights.py: do not edit.
namespace parkade {

inline constexpr double kSlotIntercept = 0.387;
inline constexpr double kSlotDoubtWeight = 0.825;
inline constexpr SlotClues kSlotWeights = {
    1.263,   // seen
    0.984,   // way_floor
    -8.029,  // way_paint
    -3.938,  // paint_across
    1.401,   // towards_car
    -4.428,  // away
    -4.233,  // lane_beyond
    1.310,   // closed
    1.499,   // t
    1.433,   // l
    -6.334,  // stop_in_front
    -2.149,  // slanted
    -2.644,  // parallel
    0.570,   // neighbours
    -6.448,  // pillar
    -2.068,  // unusual_width
    -1.448,  // skew
    -0.534,  // faint
    -2.849,  // turned_out
    -1.693,  // mark_between
    -1.412,  // bars
    -0.614,  // angle
    -0.266,  // ends_short
    -1.922,  // front_ends
};

}  // namespace parkade
