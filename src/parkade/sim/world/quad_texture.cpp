// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/quad_texture.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/sim/texel.hpp"

namespace parkade::sim {
QuadTexture::QuadTexture(const std::array<std::vector<float>, 4>& channels, int width, int height) {
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (const std::vector<float>& channel : channels) {
    PARKADE_CHECK(channel.size() == size, "{} values for {} x {}", channel.size(), width, height);
  }
  const auto pack = [&](const auto& value_of) {
    std::uint32_t texel = 0;
    for (unsigned c = 0; c < 4; ++c) {
      texel |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(value_of(c))) << 8U * c;
    }
    texels_.push_back(texel);
  };
  texels_.reserve(size + size / 2);
  for (std::size_t i = 0; i < size; ++i) {
    pack([&](unsigned c) {
      return static_cast<std::int8_t>(
          std::lround(kTexelScale * std::clamp(channels[c][i], -1.0F, 1.0F)));
    });
  }
  offsets_.push_back(0);
  widths_.push_back(width);
  heights_.push_back(height);
  while (widths_.back() >= 4 && heights_.back() >= 4) {
    const std::size_t from = static_cast<std::size_t>(offsets_.back());
    const int fine = widths_.back();
    offsets_.push_back(static_cast<std::int32_t>(texels_.size()));
    widths_.push_back(fine / 2);
    heights_.push_back(heights_.back() / 2);
    for (int y = 0; y < heights_.back(); ++y) {
      for (int x = 0; x < widths_.back(); ++x) {
        const std::size_t at = from + static_cast<std::size_t>(2 * y * fine + 2 * x);
        pack([&](unsigned c) {
          const int sum = valueOf(texels_[at], c) + valueOf(texels_[at + 1], c) +
                          valueOf(texels_[at + static_cast<std::size_t>(fine)], c) +
                          valueOf(texels_[at + static_cast<std::size_t>(fine) + 1], c);
          return static_cast<std::int8_t>(std::lround(0.25F * static_cast<float>(sum)));
        });
      }
    }
  }
}

Eigen::Vector4f QuadTexture::sample(float u, float v, float footprint) const {
  const auto index = static_cast<std::size_t>(
      std::min(mipLevelFor(footprint), static_cast<int>(widths_.size()) - 1));
  const float scale = 1.0F / static_cast<float>(1 << index);
  const int width = widths_[index];
  const int height = heights_[index];
  const float x = u * scale - 0.5F;
  const float y = v * scale - 0.5F;
  const int x0 = floorToInt(x);
  const int y0 = floorToInt(y);
  const int ax = std::clamp(x0, 0, width - 1);
  const int bx = std::clamp(x0 + 1, 0, width - 1);
  const std::uint32_t* texels = &texels_[static_cast<std::size_t>(offsets_[index])];
  const auto at = [&](int place_x, int place_y) {
    const std::uint32_t texel =
        texels[static_cast<std::size_t>(std::clamp(place_y, 0, height - 1)) *
                   static_cast<std::size_t>(width) +
               static_cast<std::size_t>(place_x)];
    return texelOf(texel);
  };
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const Eigen::Vector4f a = (1.0F - fx) * at(ax, y0) + fx * at(bx, y0);
  const Eigen::Vector4f b = (1.0F - fx) * at(ax, y0 + 1) + fx * at(bx, y0 + 1);
  return (1.0F / kTexelScale) * ((1.0F - fy) * a + fy * b);
}

}  // namespace parkade::sim
