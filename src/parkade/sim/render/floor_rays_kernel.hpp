// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace parkade::sim {

/// Sixteen rays that hit the floor, as plain arrays.
struct FloorRays {
  static constexpr int kRays = 16;
  static constexpr int kMaxTaps = 4;
  // In:
  alignas(64) float normal_x[kRays];  ///< of the floor; out: unit, towards the viewer
  float normal_y[kRays];
  float normal_z[kRays];
  float direction_x[kRays];  ///< unit
  float direction_y[kRays];
  float direction_z[kRays];
  float distance[kRays];  ///< m
  float spread[kRays];    ///< rad between neighbouring samples
  // Out:
  std::int32_t taps[kRays];  ///< of a sample, along the ray
  float footprint[kRays];    ///< m, of a tap
  float step_x[kRays];       ///< m, between taps
  float step_y[kRays];
};

/// The footprint of a sample on the floor is an ellipse, longer along the ray by 1 / cosine: taps
/// along it keep the paint sharp across while they average along. They fill the gap to the next
/// sample evenly, which cancels the beat between paint and pixels. gap: how much of the distance
/// between samples is to be filled; a lone sample needs more taps than one of four, which the
/// others complement.
void spreadOverFloor(FloorRays& rays, float gap);

/// A FloorGrid's numbers.
struct GridView {
  float min_x = 0.0F;
  float min_y = 0.0F;
  float cell = 1.0F;
  std::int32_t nx = 0;
  std::int32_t ny = 0;
};

/// Sixteen places between cell centres, as FloorGrid::bilinear: the cell, from which nx leads to
/// the next row, and the weights of the four.
struct GridPlaces {
  alignas(64) std::int32_t cell[FloorRays::kRays];
  float weights[4][FloorRays::kRays];
};
void placeInGrid(const GridView& grid, const float* x, const float* y, GridPlaces& out);

}  // namespace parkade::sim
