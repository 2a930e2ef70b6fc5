// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "parkade/types/text_reading.hpp"

namespace parkade {

// A marker's outline seldom tells surely whether one face of a pillar is in sight or two. What is
// written there does: a pillar's faces bear the same text, so that two taken for one read "B7B7"
// (or "7B7"), and one that is cut in two reads "B" and "7". docs/math/zone_markers.md.

/// What a reader says of each face, best first; at least one reading a face (checked).
using FaceReadings = std::vector<std::vector<TextReading>>;

/// What a marker bears, by all that is read of it.
struct SightText {
  std::size_t parting = 0;            ///< the one of those given that shows it best
  std::vector<TextReading> readings;  ///< best first; the empty text says that it is plain
};

/// Of the readings of an outline's faces, parted one way or more (checked).
SightText tellText(const std::vector<FaceReadings>& partings);

/// Whether readings of one parting leave no question, so that another need not be read.
bool isSettled(const FaceReadings& faces);

}  // namespace parkade
