// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace parkade::sim {

/// A repeating GreyTexture as plain arrays; level i has size >> i texels a side.
struct GreyView {
  const std::int8_t* texels = nullptr;
  const std::int32_t* offsets = nullptr;  ///< of each level in texels
  int levels = 0;
  int size = 0;
};

/// A grey texture with mip-maps, row by row, values in -1 to 1 stored in bytes. Tiles (repeats) or
/// ends at its border.
class GreyTexture {
 public:
  /// values: size x size, size a power of two.
  GreyTexture(const std::vector<float>& values, int width, int height, bool repeats);

  /// Value at texture coordinates in texels of level 0, filtered over a footprint in texels.
  [[nodiscard]] float sample(float u, float v, float footprint) const;
  /// Of a square texture that repeats; valid as long as the texture.
  [[nodiscard]] GreyView view() const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
  };
  std::vector<Level> levels_;
  std::vector<std::int32_t> offsets_;  ///< of each level in texels_
  std::vector<std::int8_t> texels_;
  bool repeats_;
};

/// Fractal value noise that repeats after size texels (a power of two), mean 0, about -1 to 1.
/// Octaves start at waves of coarsest texels and end at two texels.
std::vector<float> fractalNoise(int size, int coarsest, double roughness, std::uint64_t seed);

}  // namespace parkade::sim
