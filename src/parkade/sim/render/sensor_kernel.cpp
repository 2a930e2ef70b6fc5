// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/sensor_kernel.hpp"

#include "parkade/core/isa_clones.hpp"

namespace parkade::sim {

PARKADE_ISA_CLONES
void exposeRow(const SensorRow& row) {
  const float* const radiance = row.radiance;
  const float* const electrons_per_nit = row.electrons_per_nit;
  const float* const level_per_electron = row.level_per_electron;
  const float* const quantiles = row.quantiles;
  const std::uint8_t* const response = row.response;
  const float read_variance = row.read_variance;
  const float noise = row.noise;
  const std::uint32_t key = row.key;
  const std::uint32_t first = row.first;
  std::uint8_t* const out = row.out;
  constexpr int kBlock = 256;
  std::int32_t level[kBlock];
  for (int begin = 0; begin < row.values; begin += kBlock) {
    const int count = row.values - begin < kBlock ? row.values - begin : kBlock;
    for (int i = 0; i < count; ++i) {
      // Counter-based noise: an integer hash of the value's place (Wellons, lowbias32).
      std::uint32_t h = (first + static_cast<std::uint32_t>(begin + i)) * 0x9e3779b9U ^ key;
      h ^= h >> 16U;
      h *= 0x7feb352dU;
      h ^= h >> 15U;
      h *= 0x846ca68bU;
      h ^= h >> 16U;
      const float mean = radiance[begin + i] * electrons_per_nit[begin + i];
      const float sigma = __builtin_sqrtf(mean + read_variance);
      const float electrons = mean + noise * sigma * quantiles[h >> 20U];
      float x = electrons * level_per_electron[begin + i] + 0.5F;
      x = x < 0.0F ? 0.0F : x;
      x = x > 4095.0F ? 4095.0F : x;
      level[i] = static_cast<std::int32_t>(x);
    }
    for (int i = 0; i < count; ++i) {
      out[begin + i] = response[level[i]];
    }
  }
}

}  // namespace parkade::sim
