// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/semantics/slots/slot_clues.hpp"

// Written by tools/train/slot_weights.py: do not edit.
namespace parkade {

inline constexpr double kSlotIntercept = 0.049;
inline constexpr double kSlotDoubtWeight = 0.655;
inline constexpr SlotClues kSlotWeights = {
    1.246,   // seen
    0.724,   // way_floor
    -8.352,  // way_paint
    -3.890,  // paint_across
    2.188,   // towards_car
    -4.015,  // away
    -4.104,  // lane_beyond
    1.401,   // closed
    1.167,   // t
    1.353,   // l
    -6.437,  // stop_in_front
    -1.974,  // slanted
    -2.655,  // parallel
    0.453,   // neighbours
    -6.018,  // pillar
    -2.487,  // unusual_width
    -1.816,  // skew
    -0.532,  // faint
    -3.437,  // turned_out
    -1.798,  // mark_between
    -0.933,  // bars
    -0.539,  // angle
    -1.215,  // ends_short
};

}  // namespace parkade
