// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/image_rest.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

using Flow = std::function<Eigen::Vector2d(int camera, const Eigen::Vector2d& pixel)>;

struct Pair {
  Observations before;
  Observations now;
};

// Features spread over 640 x 480 pixels of each camera, found again with `noise_px`.
Pair look(int cameras, int features, double noise_px, const Flow& flow) {
  Random random(7);
  Pair pair;
  std::uint64_t id = 0;
  for (int camera = 0; camera < cameras; ++camera) {
    for (int k = 0; k < features; ++k, ++id) {
      WindowObservation o;
      o.camera = camera;
      o.sigma_px = 0.5;
      o.pixel = {random.uniform(0.0, 640.0), random.uniform(0.0, 480.0)};
      pair.before.emplace_back(id, o);
      o.pixel += flow(camera, o.pixel) +
                 Eigen::Vector2d(random.normal(0.0, noise_px), random.normal(0.0, noise_px));
      pair.now.emplace_back(id, o);
    }
  }
  return pair;
}

std::optional<bool> atRest(const Pair& pair) {
  return imagesAtRest(pair.before, pair.now, VioStandstillOptions());
}

const Flow kNone = [](int, const Eigen::Vector2d&) { return Eigen::Vector2d::Zero().eval(); };

TEST(ImagesAtRest, StandsWhereOnlyNoiseMoves) {
  for (const double noise : {0.0, 0.03, 0.3}) EXPECT_EQ(atRest(look(6, 60, noise, kNone)), true);
  EXPECT_EQ(atRest(look(1, 60, 0.3, kNone)), true);
}

TEST(ImagesAtRest, SaysNothingOfTooFewFeatures) {
  EXPECT_EQ(atRest(look(3, 3, 0.03, kNone)), std::nullopt);
  Pair strangers = look(6, 60, 0.03, kNone);
  for (auto& [id, o] : strangers.now) id += 1000;
  EXPECT_EQ(atRest(strangers), std::nullopt);
}

// A car that starts to roll shifts what is near by tenths of a pixel, far below the noise that
// features are believed to have.
TEST(ImagesAtRest, TellsASlowRoll) {
  const Flow roll = [](int camera, const Eigen::Vector2d& pixel) {
    return Eigen::Vector2d((camera % 2 == 0 ? 1.0 : -1.0) * 0.3 * pixel.y() / 480.0, 0.0);
  };
  EXPECT_EQ(atRest(look(6, 60, 0.03, roll)), false);
  EXPECT_EQ(atRest(look(1, 100, 0.03, roll)), false);
}

TEST(ImagesAtRest, TellsFlowThatSpreadsFromAPoint) {
  const Flow expand = [](int, const Eigen::Vector2d& pixel) {
    return Eigen::Vector2d(0.02 * (pixel - Eigen::Vector2d(320.0, 240.0)));
  };
  EXPECT_EQ(atRest(look(1, 100, 0.03, expand)), false);
}

TEST(ImagesAtRest, IgnoresWhatMovesBeforeOneCameraOfSix) {
  const Flow passing = [](int camera, const Eigen::Vector2d&) {
    return Eigen::Vector2d(camera == 2 ? 5.0 : 0.0, 0.0);
  };
  EXPECT_EQ(atRest(look(6, 60, 0.03, passing)), true);
}

}  // namespace
}  // namespace parkade
