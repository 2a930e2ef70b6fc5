// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace parkade {

/// A zone marker's place over the ground, m, and its text; empty where it was not read.
struct NamedMarker {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  std::string text;
};

/// Many garages name their pillars as a plan names its axes: along one direction all bear the same
/// letters, across it the same digits. Where markers are read so, those that contradict all of
/// their neighbours on a line take its letters or digits, and those that were not read both; a
/// whole line that bears the digits of another, out of step with those beside it, takes those
/// between them (marker_counts.hpp). No name is given twice. Nothing changes where names do not
/// follow such a grid, nor beside a border between zones, where neighbours differ.
/// docs/math/zone_markers.md, "Names in a grid".
void nameByGrid(std::vector<NamedMarker>& markers);

}  // namespace parkade
