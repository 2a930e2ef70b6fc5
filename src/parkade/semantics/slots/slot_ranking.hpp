// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/semantics/bev_views.hpp"
#include "parkade/semantics/label_probe.hpp"
#include "parkade/semantics/slots/slot_candidates.hpp"

namespace parkade {

/// Sets clues, doubt and score (log-odds of being a slot) of each candidate: what is seen of it
/// (slot_clues.hpp), then what the others say: where neighbours are narrower, a wide one has
/// probably taken in the gap beside a pillar, whose line is hidden; lines belong to one slot or the
/// other. Returns those that are told, best first: likely enough (min_confidence) and overlapping
/// no likelier one. They point into candidates.
std::vector<const SlotCandidate*> likelySlots(std::vector<SlotCandidate>& candidates,
                                              const LabelProbe& probe, const BevViews& views,
                                              double min_confidence);

/// Of slots that overlap the likelier one; best first.
std::vector<const SlotCandidate*> withoutOverlaps(std::vector<const SlotCandidate*> slots);

}  // namespace parkade
