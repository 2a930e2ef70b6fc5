// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/semantics/slots/slot_clues.hpp"

// Written by tools/train/slot_weights.py: do not edit.
namespace parkade {

inline constexpr double kSlotIntercept = 0.658;
inline constexpr double kSlotDoubtWeight = 0.707;
inline constexpr SlotClues kSlotWeights = {
    1.042,   // seen
    0.820,   // way_floor
    -7.803,  // way_paint
    -3.507,  // paint_across
    1.445,   // towards_car
    -4.066,  // away
    -4.101,  // lane_beyond
    1.504,   // closed
    1.242,   // t
    1.249,   // l
    -6.415,  // stop_in_front
    -2.055,  // slanted
    -2.524,  // parallel
    0.587,   // neighbours
    -6.247,  // pillar
    -2.099,  // unusual_width
    -1.826,  // skew
    -0.888,  // faint
    -2.871,  // turned_out
    -1.718,  // mark_between
    -1.168,  // bars
    -0.451,  // angle
};

}  // namespace parkade
