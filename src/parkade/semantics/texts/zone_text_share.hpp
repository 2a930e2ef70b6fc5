// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "parkade/semantics/networks/sequence_likelihood.hpp"

namespace parkade {

/// By how many letters a text's pattern of letters and digits repeats itself ("A1A1", "1A1" and
/// "A1A", and as well "A1B2"), as two faces of a pillar that are taken for one do; 0 where it does
/// not.
std::size_t periodOf(const std::string& text);

/// Before anything is read: how likely a marker is to be called so, 1 at most. Hardly any name
/// repeats its pattern, or begins with 0 or a dash; most have letters and digits.
double nameOdds(const std::string& name);

/// How probable it is that a patch shows a marker that bears a text: once, twice (a pillar's next
/// face bears it too), or with a part of it beside, seldom a part of it alone. Each way weighs what
/// the reader gives it. docs/math/zone_markers.md, eq. (2b).
double shareOf(const std::string& text, const SequenceLikelihood& patch);

}  // namespace parkade
