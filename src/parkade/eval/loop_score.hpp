// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/eval/statistics.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/types/trajectory.hpp"

namespace parkade {

/// How right a map's loop closures are: what each says of where its two places lie to each other,
/// against the truth.
struct LoopScore {
  int told = 0;      ///< closures between instants that the truth covers
  int wrong = 0;     ///< of them, off by more than kWrongLoopDistance or kWrongLoopAngle
  Statistics error;  ///< m, over the ground, in the directions that the closure knows
  Statistics turn;   ///< deg, of those that know the heading
};

/// Rows of look-alike slots are 2 m and more apart: a closure on the wrong slot is far beyond.
inline constexpr double kWrongLoopDistance = 0.5;  // m
inline constexpr double kWrongLoopAngle = 5.0;     // deg

/// Judges the edges of kind kLoop, in the plane: the error is along with the axes of the second
/// node, and counts only where the edge's information is that of 0.5 m (5 degrees) or better, for
/// a line says nothing of the place along itself. Neither the map's place in the truth's frame nor
/// its drift matters.
LoopScore scoreLoops(const ParkingMap& map, const Trajectory& driven);

}  // namespace parkade
