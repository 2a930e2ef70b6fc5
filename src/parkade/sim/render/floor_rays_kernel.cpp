// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/floor_rays_kernel.hpp"

#include "parkade/core/isa_clones.hpp"

namespace parkade::sim {
namespace {

constexpr float kSoftness = 2.0F;  // diameter of a sample's footprint over the spacing of samples

inline float positive(float x) {
  return x < 0.0F ? -x : x;
}

}  // namespace

PARKADE_ISA_CLONES
void spreadOverFloor(FloorRays& rays, float gap) {
  for (int k = 0; k < FloorRays::kRays; ++k) {
    float nx = rays.normal_x[k];
    float ny = rays.normal_y[k];
    float nz = rays.normal_z[k];
    const float dx = rays.direction_x[k];
    const float dy = rays.direction_y[k];
    const float dz = rays.direction_z[k];
    const float length = __builtin_sqrtf(nx * nx + (ny * ny + nz * nz));
    nx = nx / length;
    ny = ny / length;
    nz = nz / length;
    const float along = nx * dx + (ny * dy + nz * dz);
    rays.normal_x[k] = along > 0.0F ? -nx : nx;
    rays.normal_y[k] = along > 0.0F ? -ny : ny;
    rays.normal_z[k] = along > 0.0F ? -nz : nz;
    float cosine = positive(along);
    cosine = cosine < 0.02F ? 0.02F : cosine;
    const std::int32_t wanted = 1 + static_cast<std::int32_t>(gap / cosine);
    const std::int32_t taps = wanted < FloorRays::kMaxTaps ? wanted : FloorRays::kMaxTaps;
    const float pitch = rays.spread[k] * rays.distance[k] / cosine;
    float level = dx * dx + dy * dy;
    level = __builtin_sqrtf(level < 1e-12F ? 1e-12F : level);
    const float step = pitch / (static_cast<float>(taps) * level);
    rays.taps[k] = taps;
    rays.footprint[k] = kSoftness * pitch * __builtin_sqrtf(cosine / static_cast<float>(taps));
    rays.step_x[k] = step * dx;
    rays.step_y[k] = step * dy;
  }
}

PARKADE_ISA_CLONES
void placeInGrid(const GridView& grid, const float* x, const float* y, GridPlaces& out) {
  const float last_x = static_cast<float>(grid.nx - 1) - 1e-3F;
  const float last_y = static_cast<float>(grid.ny - 1) - 1e-3F;
  for (int k = 0; k < FloorRays::kRays; ++k) {
    float fx = (x[k] - grid.min_x) / grid.cell - 0.5F;
    float fy = (y[k] - grid.min_y) / grid.cell - 0.5F;
    fx = fx < 0.0F ? 0.0F : fx;
    fy = fy < 0.0F ? 0.0F : fy;
    fx = last_x < fx ? last_x : fx;
    fy = last_y < fy ? last_y : fy;
    const auto ix = static_cast<std::int32_t>(fx);
    const auto iy = static_cast<std::int32_t>(fy);
    const float ax = fx - static_cast<float>(ix);
    const float ay = fy - static_cast<float>(iy);
    out.cell[k] = iy * grid.nx + ix;
    out.weights[0][k] = (1.0F - ax) * (1.0F - ay);
    out.weights[1][k] = ax * (1.0F - ay);
    out.weights[2][k] = (1.0F - ax) * ay;
    out.weights[3][k] = ax * ay;
  }
}

}  // namespace parkade::sim
