// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/semantics/label_probe.hpp"
#include "parkade/semantics/slots/slot_candidates.hpp"

namespace parkade {

/// Slots stand in rows. Marks of side lines that are too worn to be labelled: on the line of a
/// slot's entrance, up to two widths and a pillar's place beside it, where the evidence of slot
/// lines (BevLabels::slot_line), averaged along the slot's sides, stands out over the floor on
/// either hand by min_contrast (log-odds). What goes on in front of the entrance is no side, and
/// what has a mark is known. Each holds the width of its row. None where the labels hold no
/// evidence; not beside slots along the aisle, whose sides are short. docs/math/slots.md.
std::vector<SlotMark> findFaintMarks(const BevLabels& labels,
                                     const std::vector<const SlotCandidate*>& slots,
                                     const std::vector<SlotMark>& marks, double min_contrast);

/// Marks where lines too worn for labels run beside a side that is seen (0.8 m and more), as far
/// from it as slots are usually wide (2.2 to 2.8 m), on a hand where no slot told lies. Slanted
/// ones where a line meets the side at the entrance. They are lone (SlotMark).
std::vector<SlotMark> findLoneMarks(const BevLabels& labels,
                                    const std::vector<const SlotCandidate*>& slots,
                                    const std::vector<SlotMark>& marks, double min_contrast);

}  // namespace parkade
