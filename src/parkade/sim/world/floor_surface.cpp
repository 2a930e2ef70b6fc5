// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/floor_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/sim/world/coverage.hpp"
#include "parkade/sim/world/noise_texture.hpp"
#include "parkade/sim/world/paint_layer.hpp"

namespace parkade::sim {
namespace {

constexpr float kFineTexel = 0.004F;   // m: grain of the floor's surface
constexpr float kCoarseTexel = 0.05F;  // m: clouds of wear and damp
constexpr float kMapCell = 0.04F;      // m: of the maps over the whole floor
constexpr int kNoiseSize = 512;

// A float picture over the whole floor, made once, kept as a GreyTexture.
class FloorMap {
 public:
  FloorMap(const Eigen::Vector2d& min, const Eigen::Vector2d& max) : origin_(min) {
    const Eigen::Vector2d cells = (max - min) / kMapCell;
    width_ = std::max(8, static_cast<int>(std::ceil(cells.x())));
    height_ = std::max(8, static_cast<int>(std::ceil(cells.y())));
    values_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0F);
  }

  // Applies f(value, place) to all cells within reach of a place.
  template <class Function>
  void around(const Eigen::Vector2d& center, double reach, const Function& f) {
    const Eigen::Vector2d c = (center - origin_) / kMapCell;
    const double r = reach / kMapCell;
    const int x0 = std::max(0, static_cast<int>(c.x() - r));
    const int x1 = std::min(width_ - 1, static_cast<int>(c.x() + r) + 1);
    const int y0 = std::max(0, static_cast<int>(c.y() - r));
    const int y1 = std::min(height_ - 1, static_cast<int>(c.y() + r) + 1);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Eigen::Vector2d place = origin_ + kMapCell * Eigen::Vector2d(x + 0.5, y + 0.5);
        float& value = at(x, y);
        value = f(value, place);
      }
    }
  }
  float& at(int x, int y) {
    return values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)];
  }
  void fill(const Outline& outline, float value) {
    Outline cells;
    for (const Eigen::Vector2d& p : outline) cells.emplace_back((p - origin_) / kMapCell);
    const Coverage coverage = coverageOf(cells);
    for (int y = std::max(0, coverage.y0); y < std::min(height_, coverage.y0 + coverage.height);
         ++y) {
      for (int x = std::max(0, coverage.x0); x < std::min(width_, coverage.x0 + coverage.width);
           ++x) {
        const float share = coverage.at(x, y);
        at(x, y) += share * (value - at(x, y));
      }
    }
  }
  [[nodiscard]] GreyTexture texture() const { return {values_, width_, height_, false}; }

 private:
  Eigen::Vector2d origin_;
  int width_ = 0;
  int height_ = 0;
  std::vector<float> values_;
};

// Darkening of the floor, 0 to 1: tyre marks along the ways of cars, oil, stains.
GreyTexture dirtMap(const Eigen::Vector2d& min, const Eigen::Vector2d& max, const FloorLook& look) {
  FloorMap map(min, max);
  Random random = Random(look.seed).fork("dirt");
  const auto dirt = static_cast<float>(look.dirt);
  constexpr double kHalfTrack = 0.78;  // between the two tyres of an axle, halved
  constexpr double kStep = 0.08;
  for (const Outline& track : look.tyre_tracks) {
    // Several cars, each a little to the side, each with its own strength.
    const int cars = 3 + static_cast<int>(4.0 * look.dirt);
    for (int car = 0; car < cars; ++car) {
      const double aside = random.normal(0.0, 0.18);
      const auto strength = static_cast<float>(random.uniform(0.03, 0.13)) * dirt;
      for (std::size_t i = 0; i + 1 < track.size(); ++i) {
        const Eigen::Vector2d step = track[i + 1] - track[i];
        const double length = step.norm();
        if (length <= 0.0) continue;
        const Eigen::Vector2d along = step / length;
        const Eigen::Vector2d left(-along.y(), along.x());
        for (double s = 0.0; s < length; s += kStep) {
          for (const double side : {-kHalfTrack, kHalfTrack}) {
            const Eigen::Vector2d center = track[i] + s * along + (aside + side) * left;
            map.around(center, 0.12, [&](float value, const Eigen::Vector2d& p) {
              const double across = std::abs(left.dot(p - center)) / 0.09;
              const double ahead = std::abs(along.dot(p - center)) / kStep;
              if (across >= 1.0 || ahead >= 0.5) return value;
              return value + strength * static_cast<float>(1.0 - across * across);
            });
          }
        }
      }
    }
  }
  const auto blot = [&](const Eigen::Vector2d& center, double radius, float strength) {
    const double stretch = random.uniform(0.6, 1.6);
    const double turn = random.uniform(0.0, 3.14);
    const double ripple = random.uniform(0.0, 6.28);
    map.around(center, 1.8 * radius, [&](float value, const Eigen::Vector2d& p) {
      const Eigen::Vector2d d = p - center;
      const double a = std::cos(turn) * d.x() + std::sin(turn) * d.y();
      const double b = (-std::sin(turn) * d.x() + std::cos(turn) * d.y()) * stretch;
      const double angle = std::atan2(b, a);
      const double edge = radius * (1.0 + 0.18 * std::sin(3.0 * angle + ripple) +
                                    0.10 * std::sin(7.0 * angle - 2.0 * ripple));
      const double inside = std::clamp(2.5 * (1.0 - std::hypot(a, b) / edge), 0.0, 1.0);
      return value + strength * static_cast<float>(inside);
    });
  };
  for (const Eigen::Vector2d& spot : look.oil_spots) {
    blot(spot, random.uniform(0.08, 0.32), dirt * static_cast<float>(random.uniform(0.2, 0.6)));
  }
  const double area = (max - min).prod();
  const int stains = static_cast<int>(0.25 * look.dirt * area);
  for (int i = 0; i < stains; ++i) {
    const Eigen::Vector2d place(random.uniform(min.x(), max.x()), random.uniform(min.y(), max.y()));
    blot(place, random.uniform(0.03, 0.5) * random.uniform(0.2, 1.0),
         dirt * static_cast<float>(random.uniform(-0.12, 0.3)));
  }
  return map.texture();
}

class PaintedFloor final : public FloorSurface {
 public:
  PaintedFloor(const Eigen::Vector2d& min, const Eigen::Vector2d& max, const FloorLook& look,
               const std::vector<FloorPaint>& paints)
      : origin_(min.cast<float>()),
        look_(look),
        fine_(fractalNoise(kNoiseSize, 32, 0.72, hash64(look.seed, 11)), kNoiseSize, kNoiseSize,
              true),
        coarse_(fractalNoise(kNoiseSize, 128, 0.6, hash64(look.seed, 12)), kNoiseSize, kNoiseSize,
                true),
        dirt_(dirtMap(min, max, look)),
        zones_(zoneMap(min, max, look)),
        paint_(min, max) {
    addPaints(paints);
  }

  [[nodiscard]] FloorSample sample(float x, float y, float footprint) const override {
    FloorSample out;
    // The two noises lie turned to each other and to the walls, so that no repeat lines up.
    const float fine =
        fine_.sample((0.819F * x + 0.574F * y) / kFineTexel,
                     (-0.574F * x + 0.819F * y) / kFineTexel, footprint / kFineTexel);
    const float coarse =
        coarse_.sample((0.940F * x - 0.342F * y) / kCoarseTexel,
                       (0.342F * x + 0.940F * y) / kCoarseTexel, footprint / kCoarseTexel);
    const float u = (x - origin_.x()) / kMapCell;
    const float v = (y - origin_.y()) / kMapCell;
    const float dirt = dirt_.sample(u, v, footprint / kMapCell);
    const auto grain = static_cast<float>(look_.grain);
    const auto filth = static_cast<float>(look_.dirt);
    const float shade = std::max(
        0.15F, (1.0F + 0.42F * grain * fine + (0.10F + 0.22F * filth) * coarse) * (1.0F - dirt));
    out.albedo = shade * look_.albedo;
    if (!look_.zones.empty()) {
      const float zone = 127.0F * zones_.sample(u, v, footprint / kMapCell);
      out.albedo = shade * zoneAlbedo(zone);
    }
    out.specular = look_.specular;
    out.roughness = std::clamp(look_.roughness + 0.10F * coarse + 0.4F * dirt, 0.02F, 1.0F);

    const PaintSample paint = paint_.sample(x, y, footprint);
    if (paint.coverage <= 0.0F) return out;
    const float covered = std::min(1.0F, paint.coverage);
    const float paint_shade = std::max(
        0.2F, (1.0F + 0.12F * grain * fine + 0.12F * filth * coarse) * (1.0F - 0.7F * dirt));
    out.albedo = (1.0F - covered) * out.albedo + paint_shade * paint.albedo;
    const Look& look = looks_[paint.paint];
    out.specular += covered * (look.specular - out.specular);
    out.roughness += covered * (look.roughness - out.roughness);
    if (paint.coverage > 0.5F * look.full) out.label = look.label;
    return out;
  }

 private:
  struct Look {
    SemanticClass label = SemanticClass::kFloor;
    float specular = 0.04F;
    float roughness = 0.4F;
    float full = 1.0F;  ///< coverage of unbroken worn paint; the label's threshold is half of it
  };

  // Zones are few: their numbers, divided by 127, are the map's values; neighbours are blended.
  static GreyTexture zoneMap(const Eigen::Vector2d& min, const Eigen::Vector2d& max,
                             const FloorLook& look) {
    if (look.zones.empty()) return {std::vector<float>(64, 0.0F), 8, 8, false};
    FloorMap map(min, max);
    // All zones but the first would blend through others' colours at their edges; garages have one
    // or two, so that at most the way from base to the last zone passes the first one's colour.
    float number = 0.0F;
    for (const FloorLook::Zone& zone : look.zones) map.fill(zone.outline, ++number / 127.0F);
    return map.texture();
  }
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
    const float coarse = coarse_.sample(y / kCoarseTexel, x / kCoarseTexel, 1.0F);
    const double broken = 0.75 * fine + 0.75 * coarse + 2.2 * wear - 1.9;
    return std::clamp(1.0 - 0.35 * wear - 2.5 * std::max(0.0, broken), 0.0, 1.0);
  }

  Eigen::Vector2f origin_;
  FloorLook look_;
  GreyTexture fine_;
  GreyTexture coarse_;
  GreyTexture dirt_;
  GreyTexture zones_;
  PaintLayer paint_;
  std::vector<Look> looks_;
};

}  // namespace

std::shared_ptr<const FloorSurface> makeFloorSurface(const Eigen::Vector2d& min,
                                                     const Eigen::Vector2d& max,
                                                     const FloorLook& look,
                                                     const std::vector<FloorPaint>& paints) {
  return std::make_shared<PaintedFloor>(min, max, look, paints);
}

}  // namespace parkade::sim
