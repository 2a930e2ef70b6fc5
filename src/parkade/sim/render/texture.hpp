// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "parkade/sim/scene.hpp"

namespace parkade::sim {

/// Linear light (0 to 1) of an sRGB byte, and back (IEC 61966-2-1).
float linearOfSrgb(std::uint8_t value);
float srgbOfLinear(float linear);

/// A texture in linear light with its mip levels, each half the size of the one before.
class MipTexture {
 public:
  explicit MipTexture(const Texture& texture);
  /// The mean colour over a square of about that many texels a side: bilinear in the nearest level.
  /// Texture coordinates repeat.
  [[nodiscard]] Eigen::Vector3f sample(float u, float v, float texels) const {
    Place place;
    find(u, v, texels, place);
    return read(place);
  }
  /// Four texels and where between them: what sample() reads. Finding them early lets memory
  /// work in the meantime.
  using Texel = std::array<std::uint16_t, 4>;  ///< linear, 65535 is 1
  struct Place {
    std::array<const Texel*, 4> texels{};  ///< upper two, lower two
    float right = 0.0F;                    ///< of the way to the second and fourth
    float down = 0.0F;                     ///< of the way to the lower two
    void prefetch() const {
      __builtin_prefetch(texels[0]);
      __builtin_prefetch(texels[2]);
    }
  };
  void find(float u, float v, float texels, Place& place) const;
  [[nodiscard]] static Eigen::Vector3f read(const Place& place);
  [[nodiscard]] Eigen::Vector3f mean() const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<Texel> texels;
  };
  std::vector<Level> levels_;
};

/// Diffuse reflectance of a material, its texture averaged.
Eigen::Vector3f meanAlbedo(const Scene& scene, const Material& material);

}  // namespace parkade::sim
