// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "parkade/semantics/bev_views.hpp"
#include "parkade/semantics/label_probe.hpp"

namespace parkade {

struct SlotCandidate;

inline constexpr int kNumSlotClues = 24;

/// What speaks for or against two marks being the entrance of a slot; each from 0 to about 1.
using SlotClues = std::array<double, kNumSlotClues>;

/// Stable names, by index: the columns of what weights are fitted to (tools/train/slot_weights.py).
inline constexpr std::array<std::string_view, kNumSlotClues> kSlotClueNames = {
    "seen",        "way_floor",  "way_paint",     "paint_across",
    "towards_car", "away",       "lane_beyond",   "closed",
    "t",           "l",          "stop_in_front", "slanted",
    "parallel",    "neighbours", "pillar",        "unusual_width",
    "skew",        "faint",      "turned_out",    "mark_between",
    "bars",        "angle",      "ends_short",    "front_ends"};

/// Log-odds of a slot from its clues: logistic regression over candidates in random garages of the
/// development (docs/math/slots.md, equation (3c)).
double slotLogOdds(const SlotClues& clues);

/// Log-odds that one unit of other candidates' doubt (slot_ranking.hpp) takes from a candidate.
double slotDoubtWeight();

/// Sets the clues of all candidates of a picture.
void measureSlotClues(const LabelProbe& probe, const BevViews& views,
                      std::vector<SlotCandidate>& candidates);

}  // namespace parkade
