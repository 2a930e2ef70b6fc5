// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "parkade/semantics/networks/sequence_likelihood.hpp"
#include "parkade/types/text_reading.hpp"

namespace parkade {

// A marker's outline seldom tells surely whether one face of a pillar is in sight or two, nor where
// its text ends above and below. What is written there does: a pillar's faces bear the same text,
// so that two taken for one read "B7B7" (or "7B7"), and one that is cut in two reads "B" and "7".
// docs/math/zone_markers.md.

/// What a reader says of one patch of a face.
struct FaceLook {
  SequenceLikelihood letters;
  std::vector<TextReading> readings;  ///< best first, at least one (checked)
  double odds = 1.0;                  ///< 1 at most: how likely the text is to stand there
  int down = 0;                       ///< px that the patch lies lower than the face
};

/// One face: at least one look at it (checked), the first of them where the outline says.
using FaceLooks = std::vector<FaceLook>;

/// What a marker bears, by all that is read of it.
struct SightText {
  std::size_t parting = 0;  ///< the one of those given that shows it best
  std::vector<int> down;    ///< for each face of that parting, of the look that shows it best
  std::vector<TextReading> readings;  ///< best first; the empty text says that it is plain
};

/// Of the looks at an outline's faces, parted one way or more (checked).
SightText tellText(const std::vector<std::vector<FaceLooks>>& partings);

/// Whether one parting's faces leave no question by their first looks, so that no more is needed.
bool isSettled(const std::vector<FaceLooks>& faces);

}  // namespace parkade
