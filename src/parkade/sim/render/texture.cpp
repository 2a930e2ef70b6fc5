// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/texture.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/sim/texel.hpp"

namespace parkade::sim {

float linearOfSrgb(std::uint8_t value) {
  static const std::array<float, 256> kTable = [] {
    std::array<float, 256> table{};
    for (int i = 0; i < 256; ++i) {
      const double s = i / 255.0;
      table[static_cast<std::size_t>(i)] =
          static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return table;
  }();
  return kTable[value];
}

float srgbOfLinear(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
}

MipTexture::MipTexture(const Texture& texture) {
  PARKADE_CHECK(texture.width > 0 && texture.height > 0 &&
                    texture.rgb.size() == 3U * texture.width * texture.height,
                "texture {} x {} with {} bytes", texture.width, texture.height, texture.rgb.size());
  Level base{texture.width, texture.height, {}};
  base.texels.resize(static_cast<std::size_t>(texture.width) * texture.height);
  for (std::size_t i = 0; i < base.texels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      base.texels[i][c] =
          static_cast<std::uint16_t>(std::lround(linearOfSrgb(texture.rgb[3 * i + c]) * 65535.0F));
    }
  }
  levels_.push_back(std::move(base));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level level{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
    level.texels.resize(static_cast<std::size_t>(level.width) * level.height);
    for (int y = 0; y < level.height; ++y) {
      for (int x = 0; x < level.width; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          unsigned sum = 0;
          for (int k = 0; k < 4; ++k) {
            const int fx = std::min(2 * x + k % 2, fine.width - 1);
            const int fy = std::min(2 * y + k / 2, fine.height - 1);
            sum += fine.texels[static_cast<std::size_t>(fy) * fine.width + fx][c];
          }
          level.texels[static_cast<std::size_t>(y) * level.width + x][c] =
              static_cast<std::uint16_t>((sum + 2) / 4);
        }
      }
    }
    levels_.push_back(std::move(level));
  }
}

void MipTexture::find(float u, float v, float texels, Place& place) const {
  const int wanted = texels > 1.0F ? static_cast<int>(fastLog2(texels) + 0.5F) : 0;
  const Level& level =
      levels_[static_cast<std::size_t>(std::min(wanted, static_cast<int>(levels_.size()) - 1))];
  const float x = (u - static_cast<float>(floorToInt(u))) * static_cast<float>(level.width) - 0.5F;
  const float y = (v - static_cast<float>(floorToInt(v))) * static_cast<float>(level.height) - 0.5F;
  const int left = floorToInt(x);
  const int top = floorToInt(y);
  const auto wrap = [](int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; };
  const int x0 = wrap(left, level.width);
  const int y0 = wrap(top, level.height);
  const int x1 = wrap(x0 + 1, level.width);
  const int y1 = wrap(y0 + 1, level.height);
  const auto* row0 = level.texels.data() + static_cast<std::size_t>(y0) * level.width;
  const auto* row1 = level.texels.data() + static_cast<std::size_t>(y1) * level.width;
  place.texels[0] = row0 + x0;
  place.texels[1] = row0 + x1;
  place.texels[2] = row1 + x0;
  place.texels[3] = row1 + x1;
  place.right = x - static_cast<float>(left);
  place.down = y - static_cast<float>(top);
}

Eigen::Vector3f MipTexture::read(const Place& place) {
  const float ax = place.right;
  const float ay = place.down;
  const auto& [a, b, c, d] = place.texels;
  const Eigen::Vector4f above = (1.0F - ax) * texelOf(a->data()) + ax * texelOf(b->data());
  const Eigen::Vector4f below = (1.0F - ax) * texelOf(c->data()) + ax * texelOf(d->data());
  const Eigen::Vector4f mean = (1.0F / 65535.0F) * ((1.0F - ay) * above + ay * below);
  return mean.head<3>();
}

Eigen::Vector3f MipTexture::mean() const {
  const auto& texel = levels_.back().texels.front();
  return Eigen::Vector3f(texel[0], texel[1], texel[2]) / 65535.0F;
}

Eigen::Vector3f meanAlbedo(const Scene& scene, const Material& material) {
  if (material.emission.maxCoeff() > 0.0F) {
    return Eigen::Vector3f::Zero();  // a lamp's light counts at the luminaire, not twice
  }
  if (material.texture < 0) {
    return material.albedo;
  }
  const Texture& texture = scene.textures.at(static_cast<std::size_t>(material.texture));
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < texture.rgb.size(); ++i) {
    sum[static_cast<int>(i % 3)] += linearOfSrgb(texture.rgb[i]);
  }
  return material.albedo.cwiseProduct(sum / (static_cast<float>(texture.rgb.size()) / 3.0F));
}

}  // namespace parkade::sim
