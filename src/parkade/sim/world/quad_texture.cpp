// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/quad_texture.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/sim/texel.hpp"

namespace parkade::sim {
namespace {
constexpr float kScale = 127.0F;
}  // namespace

QuadTexture::QuadTexture(const std::array<std::vector<float>, 4>& channels, int width, int height) {
  Level base{width, height, {}};
  base.texels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t c = 0; c < 4; ++c) {
    PARKADE_CHECK(channels[c].size() == base.texels.size(), "{} values for {} x {}",
                  channels[c].size(), width, height);
    for (std::size_t i = 0; i < base.texels.size(); ++i) {
      const float value = std::clamp(channels[c][i], -1.0F, 1.0F);
      base.texels[i][c] = static_cast<std::int8_t>(std::lround(kScale * value));
    }
  }
  levels_.push_back(std::move(base));
  while (levels_.back().width >= 4 && levels_.back().height >= 4) {
    const Level& fine = levels_.back();
    Level coarse{fine.width / 2, fine.height / 2, {}};
    coarse.texels.reserve(static_cast<std::size_t>(coarse.width) *
                          static_cast<std::size_t>(coarse.height));
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        const Texel* row = &fine.texels[static_cast<std::size_t>(2 * y * fine.width + 2 * x)];
        Texel texel{};
        for (std::size_t c = 0; c < 4; ++c) {
          const int sum = row[0][c] + row[1][c] + row[fine.width][c] + row[fine.width + 1][c];
          texel[c] = static_cast<std::int8_t>(std::lround(0.25F * static_cast<float>(sum)));
        }
        coarse.texels.push_back(texel);
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

Eigen::Vector4f QuadTexture::sample(float u, float v, float footprint) const {
  const int index = std::min(mipLevelFor(footprint), static_cast<int>(levels_.size()) - 1);
  const float scale = 1.0F / static_cast<float>(1 << index);
  const Level& level = levels_[static_cast<std::size_t>(index)];
  const float x = u * scale - 0.5F;
  const float y = v * scale - 0.5F;
  const int x0 = floorToInt(x);
  const int y0 = floorToInt(y);
  const int ax = std::clamp(x0, 0, level.width - 1);
  const int bx = std::clamp(x0 + 1, 0, level.width - 1);
  const Texel* row_a =
      level.texels.data() + static_cast<std::size_t>(std::clamp(y0, 0, level.height - 1)) *
                                static_cast<std::size_t>(level.width);
  const Texel* row_b =
      level.texels.data() + static_cast<std::size_t>(std::clamp(y0 + 1, 0, level.height - 1)) *
                                static_cast<std::size_t>(level.width);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const Eigen::Vector4f a =
      (1.0F - fx) * texelOf(row_a[ax].data()) + fx * texelOf(row_a[bx].data());
  const Eigen::Vector4f b =
      (1.0F - fx) * texelOf(row_b[ax].data()) + fx * texelOf(row_b[bx].data());
  return (1.0F / kScale) * ((1.0F - fy) * a + fy * b);
}

}  // namespace parkade::sim
