// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/semantics/slots/slot_clues.hpp"

// Written by tools/train/slot_weights.py: do not edit.
namespace parkade {

inline constexpr double kSlotIntercept = -0.046;
inline constexpr double kSlotDoubtWeight = 0.586;
inline constexpr SlotClues kSlotWeights = {
    1.218,   // seen
    1.032,   // way_floor
    -7.241,  // way_paint
    -2.796,  // paint_across
    1.723,   // towards_car
    -3.969,  // away
    -4.125,  // lane_beyond
    1.676,   // closed
    1.365,   // t
    1.198,   // l
    -6.199,  // stop_in_front
    -1.986,  // slanted
    -2.515,  // parallel
    0.833,   // neighbours
    -5.609,  // pillar
    -2.915,  // unusual_width
    -1.262,  // skew
    -0.847,  // faint
    -2.764,  // turned_out
    -1.128,  // mark_between
    -1.614,  // bars
    -0.834,  // angle
};

}  // namespace parkade
