// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/floor_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/random.hpp"
#include "parkade/sim/world/coverage.hpp"
#include "parkade/sim/world/noise_texture.hpp"

namespace parkade::sim {
namespace {

double sumOf(const Coverage& coverage) {
  double sum = 0.0;
  for (const float share : coverage.share) sum += share;
  return sum;
}

TEST(Coverage, IsExactForBoxesAndAddsUpToTheArea) {
  const Coverage box = coverageOf({{0.25, 1.5}, {2.5, 1.5}, {2.5, 3.0}, {0.25, 3.0}});
  EXPECT_FLOAT_EQ(box.at(0, 1), 0.375F);
  EXPECT_FLOAT_EQ(box.at(1, 1), 0.5F);
  EXPECT_FLOAT_EQ(box.at(2, 2), 0.5F);
  EXPECT_FLOAT_EQ(box.at(1, 2), 1.0F);
  // A concave arrow head, either way around.
  const std::vector<Eigen::Vector2d> arrow = {{-3.3, 0.2}, {0.1, 7.7}, {4.2, -0.4}, {0.3, 2.1}};
  double twice_area = 0.0;
  for (std::size_t i = 0; i < arrow.size(); ++i) {
    const Eigen::Vector2d& a = arrow[i];
    const Eigen::Vector2d& b = arrow[(i + 1) % arrow.size()];
    twice_area += a.x() * b.y() - b.x() * a.y();
  }
  EXPECT_NEAR(sumOf(coverageOf(arrow)), std::abs(0.5 * twice_area), 1e-4);
  EXPECT_NEAR(sumOf(coverageOf({arrow.rbegin(), arrow.rend()})), std::abs(0.5 * twice_area), 1e-4);
}

TEST(Coverage, AgreesWithCountingPoints) {
  const std::vector<Eigen::Vector2d> polygon = {{0.3, 0.4}, {5.2, 1.9}, {3.1, 5.6}, {2.0, 2.2}};
  const auto inside = [&](double x, double y) {
    bool in = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d& a = polygon[i];
      const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
      if ((a.y() > y) != (b.y() > y) &&
          x < a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y())) {
        in = !in;
      }
    }
    return in;
  };
  const Coverage coverage = coverageOf(polygon);
  for (int y = coverage.y0; y < coverage.y0 + coverage.height; ++y) {
    for (int x = coverage.x0; x < coverage.x0 + coverage.width; ++x) {
      int count = 0;
      constexpr int kSteps = 60;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        count += inside(x + (i % kSteps + 0.5) / kSteps, y + (i / kSteps + 0.5) / kSteps) ? 1 : 0;
      }
      EXPECT_NEAR(coverage.at(x, y), count / static_cast<double>(kSteps * kSteps), 0.01);
    }
  }
}

TEST(FractalNoise, RepeatsAndIsCentred) {
  const std::vector<float> noise = fractalNoise(64, 16, 0.7, 3);
  double sum = 0.0;
  for (const float value : noise) sum += value;
  EXPECT_NEAR(sum / static_cast<double>(noise.size()), 0.0, 0.2);
  const GreyTexture texture(noise, 64, 64, true);
  EXPECT_FLOAT_EQ(texture.sample(3.2F, 7.9F, 1.0F), texture.sample(67.2F, -56.1F, 1.0F));
  // With four waves a side, the mean is not far from zero.
  EXPECT_NEAR(texture.sample(10.0F, 10.0F, 500.0F), 0.0F, 0.5F);
}

FloorLook plainLook() {
  FloorLook look;
  look.grain = 0.0;
  look.dirt = 0.0;
  look.albedo = {0.2F, 0.2F, 0.2F};
  return look;
}

std::shared_ptr<const FloorSurface> floorWithLine(const FloorLook& look, double wear) {
  FloorPaint paint;
  paint.polygons = {{{2.0, 1.003}, {4.0, 1.003}, {4.0, 1.123}, {2.0, 1.123}}};
  paint.albedo = {0.8F, 0.8F, 0.8F};
  paint.wear = wear;
  return makeFloorSurface({0.0, 0.0}, {6.0, 5.0}, look, {paint});
}

TEST(FloorSurface, PaintHasItsColourLabelAndEdges) {
  const auto floor = floorWithLine(plainLook(), 0.0);
  const FloorSample on = floor->sample(3.0F, 1.06F, 0.004F);
  EXPECT_NEAR(on.albedo.x(), 0.8F, 0.01F);
  EXPECT_EQ(on.label, SemanticClass::kSlotLine);
  const FloorSample off = floor->sample(3.0F, 1.5F, 0.004F);
  EXPECT_NEAR(off.albedo.x(), 0.2F, 0.02F);
  EXPECT_EQ(off.label, SemanticClass::kFloor);
  // The edge at y = 1.003, found as the place of half brightness.
  float low = 0.95F;
  float high = 1.05F;
  while (high - low > 1e-5F) {
    const float middle = 0.5F * (low + high);
    (floor->sample(3.0F, middle, 0.004F).albedo.x() < 0.5F ? low : high) = middle;
  }
  EXPECT_NEAR(low, 1.003F, 0.0012F);
}

TEST(FloorSurface, FarAwayItIsTheMean) {
  const auto floor = floorWithLine(plainLook(), 0.0);
  // A footprint of 32 cm across a line 12 cm wide: the brightness lies between both.
  const float mean = floor->sample(3.0F, 1.06F, 0.32F).albedo.x();
  EXPECT_GT(mean, 0.3F);
  EXPECT_LT(mean, 0.7F);
}

// Places asked for together, on paint, across the seams of its tiles and outside the floor.
TEST(FloorSurface, LooksTheSameInBlocks) {
  FloorLook look;
  look.zones.push_back({{{{0, 3}, {6, 3}, {6, 5}, {0, 5}}}, {0.1F, 0.4F, 0.1F}});
  look.joints.push_back({{1.0, 0.0}, {1.0, 5.0}});
  const auto floor = floorWithLine(look, 0.5);
  Random rng(3);
  int painted = 0;
  for (int i = 0; i < 400; ++i) {
    FloorBlock block;
    block.count = 1 + i % FloorBlock::kGroups;
    int end = 0;
    for (std::size_t g = 0; g < static_cast<std::size_t>(block.count); ++g) {
      block.first[g] = end;
      block.footprint[g] = static_cast<float>(std::exp(rng.uniform(-6.0, 0.5)));
      const double x = rng.uniform(-0.3, 6.3);
      const double y = g % 2 == 0 ? rng.uniform(0.95, 1.35) : rng.uniform(-0.3, 5.3);
      const int points = g % 3 == 0 ? FloorBlock::kPoints : 1 + static_cast<int>(g % 4);
      for (int k = 0; k < points; ++k, ++end) {
        block.x[static_cast<std::size_t>(end)] = static_cast<float>(x + 0.01 * k);
        block.y[static_cast<std::size_t>(end)] = static_cast<float>(y + 0.003 * k);
      }
    }
    block.first[static_cast<std::size_t>(block.count)] = end;
    FloorLooks looks;
    floor->means(block, looks);
    for (std::size_t g = 0; g < static_cast<std::size_t>(block.count); ++g) {
      const auto first = static_cast<std::size_t>(block.first[g]);
      const FloorSample one = floor->mean(&block.x[first], &block.y[first],
                                          block.first[g + 1] - block.first[g], block.footprint[g]);
      EXPECT_NEAR(looks.red[g], one.albedo.x(), 1e-5F);
      EXPECT_NEAR(looks.green[g], one.albedo.y(), 1e-5F);
      EXPECT_NEAR(looks.blue[g], one.albedo.z(), 1e-5F);
      EXPECT_NEAR(looks.specular[g], one.specular, 1e-5F);
      EXPECT_NEAR(looks.roughness[g], one.roughness, 1e-5F);
      painted += one.albedo.x() > 0.5F ? 1 : 0;
    }
  }
  EXPECT_GT(painted, 100);
}

TEST(FloorSurface, WornPaintIsThinnerAndBroken) {
  const auto fresh = floorWithLine(plainLook(), 0.0);
  const auto worn = floorWithLine(plainLook(), 0.9);
  double mean = 0.0;
  int bare = 0;
  for (int i = 0; i < 1000; ++i) {
    const float x = 2.05F + 0.0019F * static_cast<float>(i);
    const float value = worn->sample(x, 1.06F, 0.004F).albedo.x();
    mean += value / 1000.0;
    bare += value < 0.3F ? 1 : 0;
  }
  EXPECT_LT(mean, 0.7);
  EXPECT_GT(bare, 20);
  EXPECT_NEAR(fresh->sample(2.5F, 1.06F, 0.004F).albedo.x(), 0.8F, 0.01F);
}

TEST(FloorSurface, ZonesJointsAndOutsideAreFloor) {
  FloorLook look = plainLook();
  look.zones.push_back({{{{0, 3}, {6, 3}, {6, 5}, {0, 5}}}, {0.1F, 0.4F, 0.1F}});
  look.joints.push_back({{1.0, 0.0}, {1.0, 5.0}});
  const auto floor = makeFloorSurface({0.0, 0.0}, {6.0, 5.0}, look, {});
  EXPECT_NEAR(floor->sample(3.0F, 4.0F, 0.01F).albedo.y(), 0.4F, 0.06F);
  EXPECT_NEAR(floor->sample(3.0F, 2.0F, 0.01F).albedo.y(), 0.2F, 0.03F);
  EXPECT_LT(floor->sample(1.0F, 2.0F, 0.004F).albedo.y(), 0.16F);
  for (const float x : {-20.0F, 1.0F, 30.0F}) {
    EXPECT_EQ(floor->sample(x, 2.0F, 0.01F).label, SemanticClass::kFloor);
  }
}

TEST(FloorSurface, EdgesOfZonesAreSoftAndInPlace) {
  FloorLook look = plainLook();
  // Two aisles of one colour, whose edge cuts cells a quarter of the way; and another colour.
  constexpr double kEdge = 3.01;
  look.zones.push_back(
      {{{{0, kEdge}, {2.2, kEdge}, {2.2, 5}, {0, 5}}, {{1.8, kEdge}, {6, kEdge}, {6, 5}, {1.8, 5}}},
       {0.1F, 0.4F, 0.1F}});
  look.zones.push_back({{{{0, 0}, {6, 0}, {6, 1}, {0, 1}}}, {0.4F, 0.1F, 0.1F}});
  const auto floor = makeFloorSurface({0.0, 0.0}, {6.0, 5.0}, look, {});
  // Clouds shade all colours alike.
  const auto green_over_red = [&](float x, double y, float footprint = 0.004F) {
    const Eigen::Vector3f albedo = floor->sample(x, static_cast<float>(y), footprint).albedo;
    return albedo.y() / albedo.x();
  };
  const auto share = [&](float x, double y, float footprint = 0.004F) {
    const float ratio = green_over_red(x, y, footprint);
    return (ratio - 1.0F) / (1.0F + 0.5F * ratio);
  };
  for (const float x : {1.0F, 4.0F}) {
    EXPECT_NEAR(share(x, kEdge - 0.04), 0.0F, 0.02F);
    EXPECT_LT(share(x, kEdge - 0.01) + 0.1F, share(x, kEdge));
    EXPECT_NEAR(share(x, kEdge), 0.5F, 0.12F);
    EXPECT_LT(share(x, kEdge) + 0.1F, share(x, kEdge + 0.01));
    EXPECT_NEAR(share(x, kEdge + 0.05), 1.0F, 0.02F);
    EXPECT_NEAR(share(x, kEdge, 0.3F), 0.5F, 0.2F);
  }
  EXPECT_NEAR(share(2.0F, 4.0), 1.0F, 0.01F);
  EXPECT_NEAR(green_over_red(3.0F, 0.5), 0.25F, 0.01F);
}

TEST(FloorSurface, SameSeedSameFloor) {
  FloorLook look;
  look.tyre_tracks = {{{0.0, 2.0}, {6.0, 2.5}}};
  look.oil_spots = {{3.0, 3.0}};
  const auto a = floorWithLine(look, 0.5);
  const auto b = floorWithLine(look, 0.5);
  look.seed = 2;
  const auto c = floorWithLine(look, 0.5);
  int different = 0;
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const auto x = static_cast<float>(random.uniform(0.0, 6.0));
    const auto y = static_cast<float>(random.uniform(0.0, 5.0));
    EXPECT_EQ(a->sample(x, y, 0.01F).albedo, b->sample(x, y, 0.01F).albedo);
    different += a->sample(x, y, 0.01F).albedo != c->sample(x, y, 0.01F).albedo ? 1 : 0;
  }
  EXPECT_GT(different, 150);
}

}  // namespace
}  // namespace parkade::sim
