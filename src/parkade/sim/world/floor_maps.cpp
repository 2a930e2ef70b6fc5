// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/floor_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "parkade/core/random.hpp"
#include "parkade/sim/texel.hpp"
#include "parkade/sim/world/coverage.hpp"

namespace parkade::sim {
namespace {

// A float picture over the whole floor, made once.
class FloorMap {
 public:
  FloorMap(const Eigen::Vector2d& min, const Eigen::Vector2d& max) : origin_(min) {
    const Eigen::Vector2d cells = (max - min) / kFloorMapCell;
    width_ = std::max(8, static_cast<int>(std::ceil(cells.x())));
    height_ = std::max(8, static_cast<int>(std::ceil(cells.y())));
    values_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0F);
  }

  // Applies f(value, place) to all cells within reach of a place.
  template <class Function>
  void around(const Eigen::Vector2d& center, double reach, const Function& f) {
    const Eigen::Vector2d c = (center - origin_) / kFloorMapCell;
    const double r = reach / kFloorMapCell;
    const int x0 = std::max(0, static_cast<int>(c.x() - r));
    const int x1 = std::min(width_ - 1, static_cast<int>(c.x() + r) + 1);
    const int y0 = std::max(0, static_cast<int>(c.y() - r));
    const int y1 = std::min(height_ - 1, static_cast<int>(c.y() + r) + 1);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const Eigen::Vector2d place = origin_ + kFloorMapCell * Eigen::Vector2d(x + 0.5, y + 0.5);
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
    for (const Eigen::Vector2d& p : outline) cells.emplace_back((p - origin_) / kFloorMapCell);
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
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  std::vector<float> release() { return std::move(values_); }

 private:
  Eigen::Vector2d origin_;
  int width_ = 0;
  int height_ = 0;
  std::vector<float> values_;
};

// Darkening of the floor, 0 to 1: tyre marks along the ways of cars, oil, stains.
FloorMap dirtMap(const Eigen::Vector2d& min, const Eigen::Vector2d& max, const FloorLook& look) {
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
  return map;
}

// Zones are few: multiples of one value are the map's; neighbours are blended.
FloorMap zoneMap(const Eigen::Vector2d& min, const Eigen::Vector2d& max, const FloorLook& look) {
  FloorMap map(min, max);
  // All zones but the first would blend through others' colours at their edges; garages have one
  // or two, so that at most the way from base to the last zone passes the first one's colour.
  float value = 0.0F;
  for (const FloorLook::Zone& zone : look.zones) {
    value += zoneValue(look.zones.size());
    for (const Outline& outline : zone.outlines) map.fill(outline, value);
  }
  return map;
}

// The clouds lie turned to the walls, so that no repeat lines up with them.
FloorMap cloudMap(const Eigen::Vector2d& min, const Eigen::Vector2d& max,
                  const GreyTexture& clouds) {
  FloorMap map(min, max);
  for (int j = 0; j < map.height(); ++j) {
    for (int i = 0; i < map.width(); ++i) {
      const Eigen::Vector2f p =
          (min + kFloorMapCell * Eigen::Vector2d(i + 0.5, j + 0.5)).cast<float>();
      map.at(i, j) = clouds.sample((0.940F * p.x() - 0.342F * p.y()) / kCloudTexel,
                                   (0.342F * p.x() + 0.940F * p.y()) / kCloudTexel, 1.0F);
    }
  }
  return map;
}

}  // namespace

float zoneValue(std::size_t zones) {
  const float count = std::max(1.0F, static_cast<float>(zones));
  return std::max(1.0F, std::floor(kTexelScale / count)) / kTexelScale;
}

QuadTexture makeFloorMaps(const Eigen::Vector2d& min, const Eigen::Vector2d& max,
                          const FloorLook& look, const GreyTexture& clouds) {
  FloorMap cloud = cloudMap(min, max, clouds);
  const int width = cloud.width();
  const int height = cloud.height();
  std::array<std::vector<float>, 4> channels;
  channels[kCloudChannel] = cloud.release();
  channels[kDirtChannel] = dirtMap(min, max, look).release();
  channels[kZoneChannel] = zoneMap(min, max, look).release();
  channels[3].resize(channels[0].size(), 0.0F);
  return {channels, width, height};
}

}  // namespace parkade::sim
