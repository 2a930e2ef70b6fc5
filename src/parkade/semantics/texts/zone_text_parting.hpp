// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/types/text_reading.hpp"

namespace parkade {

// A marker's outline seldom tells surely whether one face of a pillar is in sight or two. What is
// written there does: a pillar's faces bear the same text, so that two taken for one read "B7B7"
// (or "7B7", "B77"), and one that is cut in two reads "B" and "7". docs/math/zone_markers.md.

/// What a reader says of each face, best first; at least one reading a face (checked).
using FaceReadings = std::vector<std::vector<TextReading>>;

/// Readings of one patch, best first, with a text that stands there twice ("B7B7") for the text.
std::vector<TextReading> onceEach(const std::vector<TextReading>& readings);

/// Whether readings of the likelier parting leave no question, so that the other need not be read.
bool isSettled(const FaceReadings& faces, bool one_face);

/// Whether readings speak for one face rather than for two. likelier_one: what the outline says.
bool showsOneFace(const FaceReadings& one, const FaceReadings& two, bool likelier_one);

}  // namespace parkade
