// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/semantics/slots/slot_clues.hpp"

// Written by tools/train/slot_weights.py: do not edit.
namespace parkade {

inline constexpr double kSlotIntercept = 0.115;
inline constexpr double kSlotDoubtWeight = 0.591;
inline constexpr SlotClues kSlotWeights = {
    1.019,   // seen
    0.696,   // way_floor
    -6.944,  // way_paint
    -3.580,  // paint_across
    2.135,   // towards_car
    -3.776,  // away
    -4.119,  // lane_beyond
    1.598,   // closed
    1.167,   // t
    1.112,   // l
    -6.198,  // stop_in_front
    -2.115,  // slanted
    -2.555,  // parallel
    0.778,   // neighbours
    -5.876,  // pillar
    -2.908,  // unusual_width
    -1.372,  // skew
    -0.579,  // faint
    -3.295,  // turned_out
    -1.394,  // mark_between
    -1.841,  // bars
    -0.819,  // angle
};

}  // namespace parkade
