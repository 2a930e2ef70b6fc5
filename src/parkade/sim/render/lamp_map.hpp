// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/sim/scene.hpp"

namespace parkade::sim {

/// The luminaires as a glowing picture on one plane at their height, with mip levels: what a glossy
/// floor mirrors of them, averaged over its lobe without noise.
class LampMap {
 public:
  /// scale multiplies every flux.
  LampMap(const Scene& scene, double scale);

  /// Radiance, cd/m^2, that arrives along a mirror direction (unit, upwards) at a place on a floor
  /// of that roughness; cosine between direction and floor normal.
  [[nodiscard]] Eigen::Vector3f glow(const Eigen::Vector3f& p, const Eigen::Vector3f& direction,
                                     float cosine, float roughness) const;
  [[nodiscard]] float height() const { return height_; }  ///< m, of the plane

 private:
  struct Level {
    int nx = 0;
    int ny = 0;
    float cell = 0.0F;
    std::vector<Eigen::Vector4f> texels;
  };
  void draw(const Luminaire& lamp, float flux);
  [[nodiscard]] Eigen::Vector4f at(const Level& level, float x, float y) const;

  float height_ = 0.0F;
  Eigen::Vector2f min_ = Eigen::Vector2f::Zero();
  std::vector<Level> levels_;
};

}  // namespace parkade::sim
