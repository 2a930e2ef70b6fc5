// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/floor_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/sim/world/floor_kernel.hpp"
#include "parkade/sim/world/floor_maps.hpp"
#include "parkade/sim/world/noise_texture.hpp"
#include "parkade/sim/world/paint_layer.hpp"

namespace parkade::sim {
namespace {

constexpr int kNoiseSize = 512;

class PaintedFloor final : public FloorSurface {
 public:
  PaintedFloor(const Eigen::Vector2d& min, const Eigen::Vector2d& max, const FloorLook& look,
               const std::vector<FloorPaint>& paints)
      : origin_(min.cast<float>()),
        look_(look),
        grain_(static_cast<float>(look.grain)),
        filth_(static_cast<float>(look.dirt)),
        fine_(fractalNoise(kNoiseSize, 32, 0.72, hash64(look.seed, 11)), kNoiseSize, kNoiseSize,
              true),
        clouds_(fractalNoise(kNoiseSize, 128, 0.6, hash64(look.seed, 12)), kNoiseSize, kNoiseSize,
                true),
        maps_(makeFloorMaps(min, max, look, clouds_)),
        paint_(min, max) {
    addPaints(paints);
    fillGround();
  }

  [[nodiscard]] FloorSample sample(float x, float y, float footprint) const override {
    return mean(&x, &y, 1, footprint);
  }

  // Paint has sharp edges and is read at every point, what varies slowly once for all.
  [[nodiscard]] FloorSample mean(const float* xs, const float* ys, int count,
                                 float footprint) const override {
    float x = xs[0];
    float y = ys[0];
    float wide = footprint;
    if (count > 1) {
      for (int i = 1; i < count; ++i) {
        x += xs[i];
        y += ys[i];
      }
      const float n = static_cast<float>(count);
      x /= n;
      y /= n;
      wide *= 0.5F * (1.0F + std::sqrt(n));  // neighbouring discs overlap by half
    }
    FloorSample out;
    // The two noises lie turned to each other and to the walls, so that no repeat lines up.
    const float fine = fine_.sample((0.819F * x + 0.574F * y) / kFineTexel,
                                    (-0.574F * x + 0.819F * y) / kFineTexel, wide / kFineTexel);
    const Eigen::Vector4f maps = maps_.sample(
        (x - origin_.x()) / kFloorMapCell, (y - origin_.y()) / kFloorMapCell, wide / kFloorMapCell);
    const float coarse = maps[kCloudChannel];
    const float dirt = maps[kDirtChannel];
    const float shade = std::max(
        0.15F, (1.0F + 0.42F * grain_ * fine + (0.10F + 0.22F * filth_) * coarse) * (1.0F - dirt));
    out.albedo =
        shade * (look_.zones.empty() ? look_.albedo
                                     : zoneAlbedo(ground_.zones_per_value * maps[kZoneChannel]));
    out.specular = look_.specular;
    out.roughness = std::clamp(look_.roughness + 0.10F * coarse + 0.4F * dirt, 0.02F, 1.0F);

    const PaintSample paint = paint_.mean(xs, ys, count, footprint);
    if (paint.coverage <= 0.0F) return out;
    const float covered = std::min(1.0F, paint.coverage);
    const float paint_shade = std::max(
        0.2F, (1.0F + 0.12F * grain_ * fine + 0.12F * filth_ * coarse) * (1.0F - 0.7F * dirt));
    out.albedo = (1.0F - covered) * out.albedo + paint_shade * paint.albedo;
    const Look& look = looks_[paint.paint];
    out.specular += covered * (look.specular - out.specular);
    out.roughness += covered * (look.roughness - out.roughness);
    if (paint.coverage > 0.5F * look.full) out.label = look.label;
    return out;
  }

  void means(const FloorBlock& block, FloorLooks& out) const override {
    constexpr std::size_t kGroups = FloorBlock::kGroups;
    alignas(64) std::array<float, kGroups> x{};
    alignas(64) std::array<float, kGroups> y{};
    alignas(64) std::array<float, kGroups> wide{};
    const auto count = static_cast<std::size_t>(block.count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto first = static_cast<std::size_t>(block.first[i]);
      const auto end = static_cast<std::size_t>(block.first[i + 1]);
      x[i] = block.x[first];
      y[i] = block.y[first];
      for (std::size_t p = first + 1; p < end; ++p) {
        x[i] += block.x[p];
        y[i] += block.y[p];
      }
      const float n = static_cast<float>(end - first);
      x[i] /= n;
      y[i] /= n;
      wide[i] = block.footprint[i] * (0.5F * (1.0F + std::sqrt(n)));
    }
    std::fill(x.begin() + block.count, x.end(), x[0]);
    std::fill(y.begin() + block.count, y.end(), y[0]);
    std::fill(wide.begin() + block.count, wide.end(), wide[0]);
    alignas(64) std::array<float, kGroups> paint_shade;
    lookAtGround(ground_, x.data(), y.data(), wide.data(), out, paint_shade.data());
    std::array<PaintSample, kGroups> paints;
    paint_.means(block, paints);
    for (std::size_t i = 0; i < count; ++i) {
      const PaintSample& paint = paints[i];
      if (paint.coverage <= 0.0F) continue;
      const float covered = std::min(1.0F, paint.coverage);
      out.red[i] = (1.0F - covered) * out.red[i] + paint_shade[i] * paint.albedo.x();
      out.green[i] = (1.0F - covered) * out.green[i] + paint_shade[i] * paint.albedo.y();
      out.blue[i] = (1.0F - covered) * out.blue[i] + paint_shade[i] * paint.albedo.z();
      const Look& look = looks_[paint.paint];
      out.specular[i] += covered * (look.specular - out.specular[i]);
      out.roughness[i] += covered * (look.roughness - out.roughness[i]);
    }
  }

 private:
  struct Look {
    SemanticClass label = SemanticClass::kFloor;
    float specular = 0.04F;
    float roughness = 0.4F;
    float full = 1.0F;  ///< coverage of unbroken worn paint; the label's threshold is half of it
  };

  [[nodiscard]] Eigen::Vector3f zoneAlbedo(float zone) const {
    const auto colour = [&](int number) -> const Eigen::Vector3f& {
      return number <= 0 ? look_.albedo
                         : look_
                               .zones[std::min(static_cast<std::size_t>(number) - 1,
                                               look_.zones.size() - 1)]
                               .albedo;
    };
    const int below = static_cast<int>(std::floor(zone + 1e-3F));
    const float part = std::clamp(zone - static_cast<float>(below), 0.0F, 1.0F);
    return colour(below) + part * (colour(below + 1) - colour(below));
  }

  void fillGround() {
    ground_.fine = fine_.view();
    ground_.maps = maps_.view();
    ground_.origin_x = origin_.x();
    ground_.origin_y = origin_.y();
    ground_.grain = grain_;
    ground_.filth = filth_;
    ground_.specular = look_.specular;
    ground_.roughness = look_.roughness;
    ground_.zones_per_value = 1.0F / zoneValue(look_.zones.size());
    ground_.zones = std::min(static_cast<int>(look_.zones.size()), GroundTable::kMaxZones);
    for (int i = 0; i <= ground_.zones; ++i) {
      const Eigen::Vector3f& albedo =
          i == 0 ? look_.albedo : look_.zones[static_cast<std::size_t>(i) - 1].albedo;
      ground_.red[i] = albedo.x();
      ground_.green[i] = albedo.y();
      ground_.blue[i] = albedo.z();
    }
  }

  void addPaints(const std::vector<FloorPaint>& paints) {
    PARKADE_CHECK(paints.size() + 1 < std::numeric_limits<std::uint8_t>::max(),
                  "{} paints, at most 253", paints.size());
    std::vector<Eigen::Vector3f> albedo = {Eigen::Vector3f::Zero()};
    looks_.emplace_back();
    // Joints lie under all paint and are floor.
    Look joint;
    joint.roughness = 0.9F;
    looks_.push_back(joint);
    albedo.emplace_back(0.3F * look_.albedo);
    for (const Outline& line : look_.joints) {
      for (std::size_t i = 0; i + 1 < line.size(); ++i) paintJoint(line[i], line[i + 1]);
    }
    for (const FloorPaint& paint : paints) {
      const auto id = static_cast<std::uint8_t>(looks_.size());
      const double wear = paint.wear;
      looks_.push_back(
          {paint.label, paint.specular, paint.roughness, static_cast<float>(1.0 - 0.35 * wear)});
      albedo.push_back(paint.albedo);
      const auto left = [&](const Eigen::Vector2d& p) { return paintLeft(p, wear); };
      for (const Outline& outline : paint.polygons) paint_.paint(outline, id, left);
    }
    paint_.finish(std::move(albedo));
  }

  void paintJoint(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double length = (b - a).norm();
    if (length <= 0.0) return;
    constexpr double kHalfWidth = 0.006;
    const Eigen::Vector2d side = kHalfWidth * Eigen::Vector2d(-(b - a).y(), (b - a).x()) / length;
    paint_.paint({a - side, b - side, b + side, a + side}, 1, [](const auto&) { return 0.8; });
  }

  // Worn paint breaks away where fine and coarse noise agree, and thins out everywhere.
  [[nodiscard]] double paintLeft(const Eigen::Vector2d& p, double wear) const {
    if (wear <= 0.0) return 1.0;
    const auto x = static_cast<float>(p.x());
    const auto y = static_cast<float>(p.y());
    const float fine = fine_.sample(y / 0.012F, x / 0.012F, 1.0F);
    const float coarse = clouds_.sample(y / kCloudTexel, x / kCloudTexel, 1.0F);
    const double broken = 0.75 * fine + 0.75 * coarse + 2.2 * wear - 1.9;
    return std::clamp(1.0 - 0.35 * wear - 2.5 * std::max(0.0, broken), 0.0, 1.0);
  }

  Eigen::Vector2f origin_;
  FloorLook look_;
  float grain_;
  float filth_;
  GreyTexture fine_;
  GreyTexture clouds_;
  QuadTexture maps_;
  PaintLayer paint_;
  std::vector<Look> looks_;
  GroundTable ground_;  ///< for floor_kernel.hpp, of the members above
};

}  // namespace

std::shared_ptr<const FloorSurface> makeFloorSurface(const Eigen::Vector2d& min,
                                                     const Eigen::Vector2d& max,
                                                     const FloorLook& look,
                                                     const std::vector<FloorPaint>& paints) {
  return std::make_shared<PaintedFloor>(min, max, look, paints);
}

}  // namespace parkade::sim
