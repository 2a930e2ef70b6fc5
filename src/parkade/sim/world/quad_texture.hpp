// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace parkade::sim {

/// A QuadTexture as plain arrays: four values of 8 bits per texel, the first lowest.
struct QuadView {
  const std::uint32_t* texels = nullptr;
  const std::int32_t* offsets = nullptr;  ///< of each level in texels
  const std::int32_t* widths = nullptr;
  const std::int32_t* heights = nullptr;
  int levels = 0;
};

/// A texture of four values (-1 to 1, stored in bytes) with mip-maps, row by row, that ends at its
/// border. One look-up reads all four.
class QuadTexture {
 public:
  /// Each channel holds width x height values.
  QuadTexture(const std::array<std::vector<float>, 4>& channels, int width, int height);

  /// Values at texture coordinates in texels of level 0, filtered over a footprint in texels.
  [[nodiscard]] Eigen::Vector4f sample(float u, float v, float footprint) const;
  /// Valid as long as the texture.
  [[nodiscard]] QuadView view() const {
    return {texels_.data(), offsets_.data(), widths_.data(), heights_.data(),
            static_cast<int>(widths_.size())};
  }

 private:
  /// Value of a channel in a texel.
  static int valueOf(std::uint32_t texel, unsigned channel) {
    return static_cast<std::int8_t>(texel >> (8U * channel) & 0xffU);
  }
  std::vector<std::uint32_t> texels_;
  std::vector<std::int32_t> offsets_;  ///< per level
  std::vector<std::int32_t> widths_;
  std::vector<std::int32_t> heights_;
};

}  // namespace parkade::sim
