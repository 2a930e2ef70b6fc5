// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/semantics/slots/slot_clues.hpp"

// Written by tools/train/slot_weights.py: do not edit.
namespace parkade {

inline constexpr double kSlotIntercept = -0.547;
inline constexpr double kSlotDoubtWeight = 0.588;
inline constexpr SlotClues kSlotWeights = {
    1.163,   // seen
    1.149,   // way_floor
    -7.204,  // way_paint
    -3.109,  // paint_across
    2.093,   // towards_car
    -3.769,  // away
    -4.150,  // lane_beyond
    1.767,   // closed
    1.497,   // t
    0.964,   // l
    -6.166,  // stop_in_front
    -1.772,  // slanted
    -2.419,  // parallel
    0.794,   // neighbours
    -5.588,  // pillar
    -3.219,  // unusual_width
    -1.571,  // skew
    -0.885,  // faint
    -2.937,  // turned_out
    -0.688,  // mark_between
    -1.584,  // bars
    -0.623,  // angle
};

}  // namespace parkade
