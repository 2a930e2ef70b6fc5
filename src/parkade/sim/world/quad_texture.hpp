// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace parkade::sim {

/// A texture of four values (-1 to 1, stored in bytes) with mip-maps, row by row, that ends at its
/// border. One look-up reads all four.
class QuadTexture {
 public:
  /// Each channel holds width x height values.
  QuadTexture(const std::array<std::vector<float>, 4>& channels, int width, int height);

  /// Values at texture coordinates in texels of level 0, filtered over a footprint in texels.
  [[nodiscard]] Eigen::Vector4f sample(float u, float v, float footprint) const;

 private:
  using Texel = std::array<std::int8_t, 4>;
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<Texel> texels;
  };
  std::vector<Level> levels_;
};

}  // namespace parkade::sim
