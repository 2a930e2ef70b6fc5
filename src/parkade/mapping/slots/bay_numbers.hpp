// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/mapping/parking_map.hpp"

namespace parkade::slot_registry {

/// Slots that touch each other are numbered one after the other, in a whole garage from left to
/// right or from right to left for who drives in. Which way is learned from neighbours whose
/// numbers were read (three pairs at least, four of five alike); then the numbers of each bay are
/// those that most readings in it agree with, if these outweigh all others twice: they give
/// numbers to slots whose own nobody could read, and put misreadings right. Readings of neighbours
/// that follow each other are sure, and stay as they are. Where sure ones of a bay do not agree
/// (a slot between them has no number), each part of it is numbered by itself, and what lies
/// between two parts is left alone. A number that a bay with more readings has is given to no other
/// slot. support: readings that speak for each slot's number.
void numberBays(std::vector<MapSlot>& slots, const std::vector<double>& support);

}  // namespace parkade::slot_registry
