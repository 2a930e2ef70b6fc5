// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/noise_texture.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/sim/texel.hpp"

namespace parkade::sim {
namespace {

float smooth(float t) {
  return t * t * (3.0F - 2.0F * t);
}

}  // namespace

GreyTexture::GreyTexture(const std::vector<float>& values, int width, int height, bool repeats)
    : repeats_(repeats) {
  PARKADE_CHECK(values.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                "{} values for {} x {}", values.size(), width, height);
  levels_.push_back({width, height});
  offsets_.push_back(0);
  texels_.reserve(values.size() + values.size() / 2);
  for (const float value : values) {
    texels_.push_back(
        static_cast<std::int8_t>(std::lround(kTexelScale * std::clamp(value, -1.0F, 1.0F))));
  }
  while (levels_.back().width >= 4 && levels_.back().height >= 4) {
    const Level fine = levels_.back();
    const auto from = static_cast<std::size_t>(offsets_.back());
    const Level coarse{fine.width / 2, fine.height / 2};
    levels_.push_back(coarse);
    offsets_.push_back(static_cast<std::int32_t>(texels_.size()));
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        const std::int8_t* row =
            &texels_[from + static_cast<std::size_t>(2 * y * fine.width + 2 * x)];
        const int sum = row[0] + row[1] + row[fine.width] + row[fine.width + 1];
        texels_.push_back(static_cast<std::int8_t>(std::lround(0.25F * static_cast<float>(sum))));
      }
    }
  }
}

GreyView GreyTexture::view() const {
  PARKADE_CHECK(repeats_ && levels_[0].width == levels_[0].height, "{} x {} texels",
                levels_[0].width, levels_[0].height);
  return {texels_.data(), offsets_.data(), static_cast<int>(levels_.size()), levels_[0].width};
}

float GreyTexture::sample(float u, float v, float footprint) const {
  const int index = std::min(mipLevelFor(footprint), static_cast<int>(levels_.size()) - 1);
  const float scale = 1.0F / static_cast<float>(1 << index);
  const Level& level = levels_[static_cast<std::size_t>(index)];
  const float x = u * scale - 0.5F;
  const float y = v * scale - 0.5F;
  const int x0 = floorToInt(x);
  const int y0 = floorToInt(y);
  const auto place = [&](int at, int size) {
    return repeats_ ? at & (size - 1) : std::clamp(at, 0, size - 1);
  };
  const int ax = place(x0, level.width);
  const int bx = place(x0 + 1, level.width);
  const std::int8_t* texels =
      &texels_[static_cast<std::size_t>(offsets_[static_cast<std::size_t>(index)])];
  const std::int8_t* row_a = texels + static_cast<std::size_t>(place(y0, level.height)) *
                                          static_cast<std::size_t>(level.width);
  const std::int8_t* row_b = texels + static_cast<std::size_t>(place(y0 + 1, level.height)) *
                                          static_cast<std::size_t>(level.width);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const float a = static_cast<float>(row_a[ax]) * (1.0F - fx) + static_cast<float>(row_a[bx]) * fx;
  const float b = static_cast<float>(row_b[ax]) * (1.0F - fx) + static_cast<float>(row_b[bx]) * fx;
  return (a * (1.0F - fy) + b * fy) / kTexelScale;
}

std::vector<float> fractalNoise(int size, int coarsest, double roughness, std::uint64_t seed) {
  PARKADE_CHECK(size > 0 && (size & (size - 1)) == 0 && (coarsest & (coarsest - 1)) == 0,
                "noise of {} texels with waves of {}", size, coarsest);
  std::vector<float> values(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0F);
  double amplitude = 1.0;
  double power = 0.0;
  std::uint64_t octave = 0;
  for (int wave = coarsest; wave >= 1; wave /= 2, amplitude *= roughness, ++octave) {
    const int lattice = size / wave;
    const auto at = [&](int x, int y) {
      const auto key = static_cast<std::uint64_t>((y % lattice) * lattice + x % lattice);
      const std::uint64_t bits = hash64(hash64(seed, octave), key);
      return static_cast<float>(bits >> 40) * 0x1.0p-23F - 1.0F;
    };
    for (int y = 0; y < size; ++y) {
      const float fy = smooth(static_cast<float>(y % wave) / static_cast<float>(wave));
      for (int x = 0; x < size; ++x) {
        const float fx = smooth(static_cast<float>(x % wave) / static_cast<float>(wave));
        const int lx = x / wave;
        const int ly = y / wave;
        const float top = at(lx, ly) * (1.0F - fx) + at(lx + 1, ly) * fx;
        const float low = at(lx, ly + 1) * (1.0F - fx) + at(lx + 1, ly + 1) * fx;
        values[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
               static_cast<std::size_t>(x)] +=
            static_cast<float>(amplitude) * (top * (1.0F - fy) + low * fy);
      }
    }
    power += amplitude * amplitude / 3.0;
  }
  // Two standard deviations span -1 to 1.
  const auto scale = static_cast<float>(0.5 / std::sqrt(0.6 * power));
  for (float& value : values) value *= scale;
  return values;
}

}  // namespace parkade::sim
