// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

FloorSample FloorSurface::mean(const float* x, const float* y, int count, float footprint) const {
  FloorSample sum = sample(x[0], y[0], footprint);
  for (int i = 1; i < count; ++i) {
    const FloorSample next = sample(x[i], y[i], footprint);
    sum.albedo += next.albedo;
    sum.specular += next.specular;
    sum.roughness += next.roughness;
  }
  const float share = 1.0F / static_cast<float>(count);
  sum.albedo *= share;
  sum.specular *= share;
  sum.roughness *= share;
  return sum;
}

void FloorSurface::means(const FloorBlock& block, FloorLooks& out) const {
  for (int i = 0; i < block.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto first = static_cast<std::size_t>(block.first[at]);
    const FloorSample look = mean(&block.x[first], &block.y[first],
                                  block.first[at + 1] - block.first[at], block.footprint[at]);
    out.red[at] = look.albedo.x();
    out.green[at] = look.albedo.y();
    out.blue[at] = look.albedo.z();
    out.specular[at] = look.specular;
    out.roughness[at] = look.roughness;
  }
}

}  // namespace parkade::sim
