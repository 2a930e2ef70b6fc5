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
  [[nodiscard]] Eigen::Vector3f sample(float u, float v, float texels) const;
  [[nodiscard]] Eigen::Vector3f mean() const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<std::array<std::uint16_t, 4>> texels;  ///< linear, 65535 is 1
  };
  std::vector<Level> levels_;
};

/// Diffuse reflectance of a material, its texture averaged.
Eigen::Vector3f meanAlbedo(const Scene& scene, const Material& material);

}  // namespace parkade::sim
