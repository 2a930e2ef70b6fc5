// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace parkade::sim {

// What the writer and the reader of garage.json share.

inline constexpr int kGarageVersion = 1;
/// By value of SlotType and SlotMarking.
inline constexpr std::array<const char*, 3> kSlotTypeNames = {"perpendicular", "parallel",
                                                              "slanted"};
inline constexpr std::array<const char*, 4> kSlotMarkingNames = {"closed", "t_shaped", "l_shaped",
                                                                 "open"};

}  // namespace parkade::sim
