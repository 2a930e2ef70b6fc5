// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "parkade/sim/scene.hpp"

namespace parkade::sim {

/// Adds materials and textures to a scene.
class Palette {
 public:
  explicit Palette(Scene& scene) : scene_(scene) {}

  std::uint16_t add(const std::string& name, SemanticClass label, const Eigen::Vector3f& albedo,
                    float roughness = 0.9F, float specular = 0.04F, int texture = -1);
  /// A surface that glows by itself: radiance relative to a floor of 1 lux.
  std::uint16_t addGlow(const std::string& name, SemanticClass label,
                        const Eigen::Vector3f& emission, int texture = -1);
  /// Index of the texture.
  int addTexture(Texture texture);

  Scene& scene() { return scene_; }

 private:
  Scene& scene_;
};

/// Clouds, specks and streaks around white, as on concrete and paint. Repeats; mean about 0.85.
Texture stainTexture(int size, double contrast, std::uint64_t seed);

/// Yellow and black stripes at 45 degrees, one pair per repeat.
Texture stripeTexture(int size);

/// How a line of text sits on a plate.
struct PlateStyle {
  Eigen::Vector3f back{0.05F, 0.3F, 0.3F};
  Eigen::Vector3f ink{0.8F, 0.8F, 0.8F};
  double weight = 0.16;
};

/// A plate of a size in metres with a line of text of a height, `off` metres from its middle.
Texture plateTexture(double width, double height, const std::string& text, double text_height,
                     const PlateStyle& style, double px_per_metre = 320.0,
                     const Eigen::Vector2d& off = Eigen::Vector2d::Zero());

/// A hanging guide sign: a word and an arrow ("exit_left", "EXIT", "parking_straight").
Texture guideTexture(double width, double height, const std::string& meaning);

/// A round speed-limit plate on its square: red ring, black number.
Texture limitTexture(const std::string& text, double weight);

/// Posters and notices: blocks of colour and lines of text.
Texture posterTexture(std::uint64_t seed);

}  // namespace parkade::sim
