// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/feature_manager.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "parkade/vio/track_simulator.hpp"

namespace parkade {
namespace {

WindowFrame frameAt(int id, double seconds) {
  WindowFrame frame;
  frame.id = id;
  frame.t_ns = fromSeconds(seconds);
  return frame;
}

WindowObservation viewAt(int frame_id, int camera, const Eigen::Vector2d& pixel) {
  WindowObservation o;
  o.frame_id = frame_id;
  o.camera = camera;
  o.pixel = pixel;
  o.sigma_px = 0.5;
  return o;
}

std::vector<VioCamera> camerasOfRig(std::size_t count) {
  std::vector<VioCamera> cameras;
  for (const RigCamera& camera : testing::surroundRig().cameras) {
    if (cameras.size() < count) cameras.push_back({camera.camera, camera.T_vehicle_cam});
  }
  return cameras;
}

// Each camera sees twelve points 5 m away, from two places 0.3 m apart.
Window placedFeatures(std::size_t cameras) {
  Window window;
  window.cameras = camerasOfRig(cameras);
  window.frames = {frameAt(0, 0.0), frameAt(1, 0.1)};
  window.frames[1].state.p_odom.x() = 0.3;
  std::uint64_t id = 0;
  for (std::size_t c = 0; c < cameras; ++c) {
    const VioCamera& camera = window.cameras[c];
    for (int k = 0; k < 12; ++k) {
      WindowFeature feature;
      feature.id = ++id;
      const Eigen::Vector2d pixel(200.0 + 60.0 * (k % 4), 120.0 + 70.0 * (k / 4));
      EXPECT_TRUE(camera.camera.unproject(pixel, feature.direction));
      feature.inverse_distance = 0.2;
      feature.has_point = true;
      feature.anchor_camera = static_cast<int>(c);
      feature.last_seen_id = 1;
      const Eigen::Vector3d point = camera.T_imu_cam * Eigen::Vector3d(5.0 * feature.direction);
      Eigen::Vector2d later = Eigen::Vector2d::Zero();
      EXPECT_TRUE(camera.camera.project(
          camera.T_imu_cam.inverse() * Eigen::Vector3d(point - window.frames[1].state.p_odom),
          later));
      feature.observations = {viewAt(0, feature.anchor_camera, pixel),
                              viewAt(1, feature.anchor_camera, later)};
      window.features.emplace(id, feature);
    }
  }
  return window;
}

const Eigen::Matrix<double, 6, 6> kSharp = 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();

TEST(FeatureGate, KeepsAllWhereThePredictionIsRight) {
  Window window = placedFeatures(6);
  FeatureManager manager{VioOptions{}};
  const GateResult gate = manager.gateNewest(window, kSharp);
  EXPECT_EQ(gate.checked, 72);
  EXPECT_EQ(gate.rejected, 0);
  EXPECT_FALSE(gate.contradicted);
}

TEST(FeatureGate, RejectsTheCameraThatContradicts) {
  Window window = placedFeatures(6);
  for (auto& [id, feature] : window.features) {
    if (feature.anchor_camera == 1) feature.observations.back().pixel.x() += 12.0;
  }
  FeatureManager manager{VioOptions{}};
  const GateResult gate = manager.gateNewest(window, kSharp);
  EXPECT_EQ(gate.cameras, std::vector<int>{1});
  EXPECT_EQ(gate.rejected, 12);
  EXPECT_FALSE(gate.contradicted);
  for (const auto& [id, feature] : window.features) {
    EXPECT_EQ(feature.observations.size(), feature.anchor_camera == 1 ? 1U : 2U);
  }
}

TEST(FeatureGate, DistrustsThePredictionThatMostCamerasContradict) {
  Window window = placedFeatures(6);
  window.frames[1].state.p_odom += Eigen::Vector3d(0.2, 0.2, 0.0);
  FeatureManager manager{VioOptions{}};
  const GateResult gate = manager.gateNewest(window, kSharp);
  EXPECT_TRUE(gate.contradicted);
  EXPECT_EQ(gate.rejected, 0);
  EXPECT_TRUE(gate.cameras.empty());
  ASSERT_EQ(window.features.size(), 72U);
  std::vector<WindowFeature*> features;
  for (auto& [id, feature] : window.features) {
    EXPECT_EQ(feature.observations.size(), 2U);
    EXPECT_EQ(feature.failures, 0);
    feature.failures = 2;  // one more, and it would be banned
    features.push_back(&feature);
  }
  // What still misses after the solve goes, but it is not the features' fault.
  EXPECT_GT(manager.rejectOutliers(window, features), 40);
  EXPECT_LT(window.features.size(), 40U);
  Observations again;
  for (std::uint64_t id = 1; id <= 72; ++id) again.emplace_back(id, viewAt(1, 0, {320.0, 200.0}));
  manager.add(window, again);
  EXPECT_EQ(window.features.size(), 72U);
}

TEST(FeatureGate, ASingleCameraIsNoMajority) {
  Window window = placedFeatures(1);
  window.frames[1].state.p_odom += Eigen::Vector3d(0.2, 0.2, 0.0);
  FeatureManager manager{VioOptions{}};
  const GateResult gate = manager.gateNewest(window, kSharp);
  EXPECT_FALSE(gate.contradicted);
  EXPECT_EQ(gate.cameras, std::vector<int>{0});
  EXPECT_EQ(gate.rejected, 12);
}

// A hundred landmarks of before, of which some are in sight, and a hundred new ones.
Window afterDarkness(int in_sight) {
  Window window;
  window.cameras = camerasOfRig(6);
  window.frames = {frameAt(0, 0.0), frameAt(1, 0.1), frameAt(2, 5.0), frameAt(3, 5.1)};
  for (int k = 0; k < 200; ++k) {
    WindowFeature feature;
    feature.id = static_cast<std::uint64_t>(k);
    const bool old = k < 100;
    const int first = old ? 0 : 2;
    feature.has_point = true;
    feature.selected = old;
    feature.anchor_frame_id = first;
    feature.anchor_camera = k % 6;
    const Eigen::Vector2d pixel(20.0 + 3.0 * k, 10.0 + 37.0 * (k % 10));
    feature.observations = {viewAt(first, k % 6, pixel), viewAt(first + 1, k % 6, pixel)};
    if (k < in_sight) feature.observations.push_back(viewAt(3, k % 6, pixel));
    feature.last_seen_id = feature.observations.back().frame_id;
    window.features.emplace(feature.id, feature);
  }
  return window;
}

TEST(FeatureSelection, NewLandmarksFindRoomAfterDarkness) {
  VioOptions options;
  options.window.max_landmarks = 100;
  FeatureManager manager(options);
  Window window = afterDarkness(0);
  const std::vector<WindowFeature*> chosen = manager.select(window);
  EXPECT_EQ(chosen.size(), 100U);
  const auto isNew = [](const WindowFeature* feature) { return feature->id >= 100; };
  EXPECT_EQ(std::count_if(chosen.begin(), chosen.end(), isNew), 50);
  for (const auto& [id, feature] : window.features) {
    const bool taken = std::find(chosen.begin(), chosen.end(), &feature) != chosen.end();
    EXPECT_EQ(feature.selected, taken) << id;
  }
}

TEST(FeatureSelection, LandmarksStayWhereManyAreInSight) {
  VioOptions options;
  options.window.max_landmarks = 100;
  FeatureManager manager(options);
  Window window = afterDarkness(40);
  const std::vector<WindowFeature*> chosen = manager.select(window);
  EXPECT_EQ(chosen.size(), 100U);
  for (const WindowFeature* feature : chosen) EXPECT_LT(feature->id, 100U);
}

}  // namespace
}  // namespace parkade
