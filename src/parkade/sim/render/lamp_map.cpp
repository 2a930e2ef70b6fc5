// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/lamp_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "parkade/sim/texel.hpp"

namespace parkade::sim {
namespace {

constexpr float kMapCell = 0.1F;    // m
constexpr float kMargin = 2.0F;     // m around the lamps
constexpr float kFarthest = 60.0F;  // m along a mirror ray
constexpr float kLobeWidth = 2.6F;  // diameter at half height of the mirrored GGX lobe over alpha
constexpr int kMaxTaps = 6;
constexpr float kTail = 0.4F;

}  // namespace

LampMap::LampMap(const Scene& scene, double scale) {
  if (scene.luminaires.empty()) {
    return;
  }
  Eigen::Vector2f low = Eigen::Vector2f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector2f high = -low;
  double height = 0.0;
  for (const Luminaire& lamp : scene.luminaires) {
    for (const Eigen::Vector3f& end : {lamp.end_a, lamp.end_b}) {
      low = low.cwiseMin(end.head<2>());
      high = high.cwiseMax(end.head<2>());
      height += end.z();
    }
  }
  height_ = static_cast<float>(height / (2.0 * static_cast<double>(scene.luminaires.size())));
  min_ = low.array() - kMargin;
  Level base;
  base.cell = kMapCell;
  base.nx = static_cast<int>((high.x() + kMargin - min_.x()) / kMapCell) + 1;
  base.ny = static_cast<int>((high.y() + kMargin - min_.y()) / kMapCell) + 1;
  base.texels.assign(static_cast<std::size_t>(base.nx) * base.ny, Eigen::Vector4f::Zero());
  levels_.push_back(std::move(base));
  for (const Luminaire& lamp : scene.luminaires) {
    draw(lamp, static_cast<float>(lamp.flux_lm * scale));
  }
  while (levels_.back().cell < 6.0F) {
    const Level& fine = levels_.back();
    Level level;
    level.cell = 2.0F * fine.cell;
    level.nx = (fine.nx + 1) / 2;
    level.ny = (fine.ny + 1) / 2;
    level.texels.assign(static_cast<std::size_t>(level.nx) * level.ny, Eigen::Vector4f::Zero());
    for (int y = 0; y < fine.ny; ++y) {
      for (int x = 0; x < fine.nx; ++x) {
        level.texels[static_cast<std::size_t>(y / 2) * level.nx + x / 2] +=
            0.25F * fine.texels[static_cast<std::size_t>(y) * fine.nx + x];
      }
    }
    levels_.push_back(std::move(level));
  }
}

/// Spreads the flux over the cells below the tube, as radiance of a Lambertian source.
void LampMap::draw(const Luminaire& lamp, float flux) {
  Level& base = levels_.front();
  const Eigen::Vector2f a = lamp.end_a.head<2>();
  const Eigen::Vector2f b = lamp.end_b.head<2>();
  const int steps = std::max(1, static_cast<int>((b - a).norm() / (0.25F * kMapCell)));
  const float share = flux / std::numbers::pi_v<float> / (kMapCell * kMapCell) / steps;
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2f p = a + (b - a) * ((i + 0.5F) / steps) - min_;
    // Bilinear splat: no steps between cells.
    const float fx = p.x() / kMapCell - 0.5F;
    const float fy = p.y() / kMapCell - 0.5F;
    const int x = static_cast<int>(fx);
    const int y = static_cast<int>(fy);
    for (int k = 0; k < 4; ++k) {
      const float wx = k % 2 == 0 ? 1.0F - (fx - x) : fx - x;
      const float wy = k / 2 == 0 ? 1.0F - (fy - y) : fy - y;
      base.texels[static_cast<std::size_t>(y + k / 2) * base.nx + x + k % 2].head<3>() +=
          wx * wy * share * lamp.colour;
    }
  }
}

Eigen::Vector4f LampMap::at(const Level& level, float x, float y) const {
  const float fx = (x - min_.x()) / level.cell - 0.5F;
  const float fy = (y - min_.y()) / level.cell - 0.5F;
  if (fx < 0.0F || fy < 0.0F || fx >= static_cast<float>(level.nx - 1) ||
      fy >= static_cast<float>(level.ny - 1)) {
    return Eigen::Vector4f::Zero();  // the margin around the lamps is dark
  }
  const int ix = static_cast<int>(fx);
  const int iy = static_cast<int>(fy);
  const float ax = fx - static_cast<float>(ix);
  const float ay = fy - static_cast<float>(iy);
  const Eigen::Vector4f* row = level.texels.data() + static_cast<std::size_t>(iy) * level.nx + ix;
  const Eigen::Vector4f low = (1.0F - ax) * row[0] + ax * row[1];
  const Eigen::Vector4f high = (1.0F - ax) * row[level.nx] + ax * row[level.nx + 1];
  return (1.0F - ay) * low + ay * high;
}

Eigen::Vector3f LampMap::glow(const Eigen::Vector3f& p, const Eigen::Vector3f& direction,
                              float cosine, float roughness) const {
  const float rise = height_ - p.z();
  if (levels_.empty() || direction.z() < 0.02F || rise < 0.3F || rise > kFarthest * direction.z()) {
    return Eigen::Vector3f::Zero();
  }
  const float t = rise / direction.z();
  // The lobe's print on the plane: its azimuth narrows by the cosine, its length grows by it.
  const float width = kLobeWidth * std::max(roughness * roughness, 0.004F) * t;
  const float across = std::max(width * cosine, kMapCell);
  const float along = std::max(width / std::max(cosine, 0.05F), across);
  const int taps = std::min(kMaxTaps, static_cast<int>(along / across + 0.5F));
  const float print = std::max(across, along / static_cast<float>(taps));
  const float wanted = fastLog2(print / kMapCell);
  const int last = static_cast<int>(levels_.size()) - 1;
  const int level = std::clamp(static_cast<int>(wanted), 0, last);
  const float blend =
      level < last ? std::clamp(wanted - static_cast<float>(level), 0.0F, 1.0F) : 0.0F;
  Eigen::Vector2f step = direction.head<2>();
  step *= along / (static_cast<float>(taps) * std::max(step.norm(), 1e-6F));
  const Eigen::Vector2f q = p.head<2>() + t * direction.head<2>();
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int k = 0; k < taps; ++k) {
    const float offset = static_cast<float>(k) - 0.5F * static_cast<float>(taps - 1);
    const Eigen::Vector2f place = q + offset * step;
    sum += (1.0F - blend) * at(levels_[static_cast<std::size_t>(level)], place.x(), place.y());
    if (blend > 0.0F) {
      sum += blend * at(levels_[static_cast<std::size_t>(level) + 1], place.x(), place.y());
    }
  }
  // GGX has long tails: part of the light comes from a print three times as wide.
  const int wide = std::min(level + 2, last);
  return (1.0F - kTail) / static_cast<float>(taps) * sum.head<3>() +
         kTail * at(levels_[static_cast<std::size_t>(wide)], q.x(), q.y()).head<3>();
}

}  // namespace parkade::sim
