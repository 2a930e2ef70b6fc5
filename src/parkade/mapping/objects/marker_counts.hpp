// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

namespace parkade {

/// A line of markers that bear one number: where it lies across the lines, m, and the number.
struct CountedLine {
  double across = 0.0;
  int number = 0;
};

/// Numbers of lines go up, or down, by one from each line to the next. Where those of most lines
/// do, a line that bears the number of another and is the one of the two out of step with the lines
/// beside it was misread. What it should bear, in the order of the lines; nothing for those that
/// are right, or of which the others do not tell it. docs/math/zone_markers.md, "Names in a grid".
std::vector<std::optional<int>> mendedCounts(const std::vector<CountedLine>& lines);

}  // namespace parkade
