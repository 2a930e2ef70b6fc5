// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/check.hpp"
#include "parkade/sim/render/ray_table.hpp"
#include "parkade/sim/render/test_scene.hpp"

namespace parkade::sim {
namespace {

Camera smallCamera() {
  PinholeRadtan::Parameters p;
  p.fx = p.fy = 135.0;
  p.cx = 159.5;
  p.cy = 99.5;
  return {CameraModel(PinholeRadtan(p)), 320, 200};
}

std::vector<test::PaintedRect> paint() {
  return {
      {{-4.0F, -1.0F}, {6.0F, -0.85F}, Eigen::Vector3f::Constant(0.75F), SemanticClass::kSlotLine}};
}

/// The hall with a car that drives across, an own car and a flickering tube.
std::shared_ptr<Scene> busyHall(double lux = 200.0) {
  auto scene = test::makeHall(paint(), lux);
  const int car = static_cast<int>(scene->meshes.size());
  scene->meshes.push_back(test::makeBox({-2.0F, -0.9F, 0.2F}, {2.0F, 0.9F, 1.4F}, test::kCarM));
  scene->ego_mesh = car;
  MovingObject object;
  object.instance = 77;
  object.box_size << 4.0, 1.8, 1.4;
  object.pose = [](double t) { return SE3(SO3(), Eigen::Vector3d(2.0 + t, 3.0, 0.0)); };
  object.mesh = [car](double) { return car; };
  object.head_lamps = true;
  scene->moving.push_back(object);
  scene->luminaires[0].flicker_hz = 3.0F;
  scene->luminaires[0].flicker_depth = 0.5F;
  return scene;
}

bool sameBytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

TEST(Renderer, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const bool fast : {false, true}) {
    cv::Mat images[2];
    cv::Mat ortho[2];
    for (int i = 0; i < 2; ++i) {
      RenderOptions options;
      options.fast = fast;
      options.threads = i == 0 ? 1 : 2;
      Renderer renderer(busyHall(), options);
      const int camera = renderer.addCamera(smallCamera());
      const auto moment = renderer.moment(0.4, SE3(SO3(), {-7.5, 0.0, 0.0}));
      images[i] = renderer.render(camera, test::lookAlongX(0.3), *moment, 5);
      ortho[i] = renderer.renderOrtho(SE3(), 64, 0.1, 0.4).colour;
    }
    EXPECT_TRUE(sameBytes(images[0], images[1]));
    EXPECT_TRUE(sameBytes(ortho[0], ortho[1]));
  }
}

// Where a surface ends a pixel shows its share of both, also with one sample per pixel elsewhere;
// but for pixels at the borders of tiles, of which each looks at its own alone.
TEST(Renderer, FastPicturesHaveSmoothEdges) {
  Radiance drawn[2];
  TruthImages truth;
  for (const bool fast : {false, true}) {
    RenderOptions options;
    options.fast = fast;
    options.reflections = false;
    Renderer renderer(busyHall(), options);
    const int camera = renderer.addCamera(smallCamera());
    const auto moment = renderer.moment(0.4, std::nullopt);
    drawn[fast ? 1 : 0] = renderer.renderRadiance(camera, test::lookAlongX(0.1), *moment);
    truth = renderer.renderTruth(camera, test::lookAlongX(0.1), *moment);
  }
  int edges = 0;
  int alike = 0;
  for (int y = 0; y < truth.labels.rows; ++y) {
    for (int x = 0; x + 1 < truth.labels.cols; ++x) {
      const auto standing = [&](int column) {
        const auto label = static_cast<SemanticClass>(truth.labels.at<std::uint8_t>(y, column));
        return label == SemanticClass::kPillar || label == SemanticClass::kVehicle;
      };
      if (standing(x) == standing(x + 1)) continue;
      const auto at = static_cast<std::size_t>(y) * drawn[0].width + x;
      const float full = drawn[0].pixels[at].y();
      ++edges;
      alike += std::abs(drawn[1].pixels[at].y() - full) < 0.03F * full ? 1 : 0;
    }
  }
  EXPECT_GT(edges, 100);
  EXPECT_GT(alike, 0.85 * edges) << alike << " of " << edges;
}

// An upright or level edge that moves across a pixel passes its samples a quarter pixel apart.
TEST(Renderer, EdgesMeetSamplesOneByOne) {
  for (const int axis : {0, 1}) {
    std::vector<double> places;
    for (int k = 0; k < 4; ++k) places.push_back(RayTable::samplePlace(k)[axis]);
    std::sort(places.begin(), places.end());
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_DOUBLE_EQ(places[k], 0.25 * (static_cast<double>(k) - 1.5)) << "axis " << axis;
  }
}

TEST(Renderer, NoiseDependsOnFrameAndCamera) {
  Renderer renderer(busyHall(), RenderOptions{});
  const int a = renderer.addCamera(smallCamera());
  const int b = renderer.addCamera(smallCamera());
  const auto moment = renderer.moment(0.0, std::nullopt);
  const SE3 pose = test::lookAlongX(0.3);
  const cv::Mat first = renderer.render(a, pose, *moment, 1);
  EXPECT_TRUE(sameBytes(first, renderer.render(a, pose, *moment, 1)));
  EXPECT_FALSE(sameBytes(first, renderer.render(a, pose, *moment, 2)));
  EXPECT_FALSE(sameBytes(first, renderer.render(b, pose, *moment, 1)));
}

TEST(Renderer, MeanFloorLightMeetsTheTarget) {
  for (const double lux : {10.0, 200.0, 1000.0}) {
    const auto scene = test::makeHall(paint(), lux);
    Renderer renderer(scene, RenderOptions{});
    // Measured apart from the baking code: the mean over the floor that no object covers.
    const BakedLight& light = renderer.light();
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < light.floor.size(); ++i) {
      const Eigen::Vector2f p = light.floor_grid.center(i);
      const bool pillar = p.x() > 4.0F && p.x() < 4.6F && p.y() > 1.5F && p.y() < 2.1F;
      const bool car = p.x() > 1.5F && p.x() < 6.0F && p.y() > -5.5F && p.y() < -3.7F;
      if (!pillar && !car) {
        sum += luminance(light.floor[i].lux);
        ++count;
      }
    }
    EXPECT_NEAR(sum / count, lux, 0.02 * lux);
    // Eight tubes of 3000 lm over 280 m^2: less than all of it, more than a third, reaches the
    // floor.
    EXPECT_GT(light.raw_floor_lux, 8 * 3000.0 / 280.0 * 0.35);
    EXPECT_LT(light.raw_floor_lux, 8 * 3000.0 / 280.0 * 1.2);
  }
}

TEST(Renderer, LightIsBrighterBelowLampsAndDarkBelowCars) {
  Renderer renderer(test::makeHall(paint()), RenderOptions{});
  const BakedLight& light = renderer.light();
  const auto luxAt = [&](float x, float y) {
    return luminance(light.floor[light.floor_grid.index(x, y)].lux);
  };
  EXPECT_GT(luxAt(-2.0F, -3.0F), 1.15F * luxAt(0.5F, 0.0F));
  EXPECT_LT(luxAt(3.5F, -4.6F), 0.1F * luxAt(0.5F, 0.0F));
  // The shadow of the car's edge is soft: between full shadow and light there are steps.
  const float mid = luxAt(3.0F, -5.7F) / luxAt(3.0F, -6.6F);
  EXPECT_LT(mid, 0.95F);
}

TEST(Renderer, OneLampFollowsThePhotometricLaw) {
  // A single lamp 3 m over a black world: E = I cos(theta) cos(beta) / d^2 with I = 0.88 flux / pi.
  auto scene = std::make_shared<Scene>();
  Material black;
  black.albedo.setZero();
  black.is_floor = true;
  scene->materials.push_back(black);
  Mesh floor;
  floor.vertices = {{-6, -6, 0}, {6, -6, 0}, {6, 6, 0}, {-6, 6, 0}};
  floor.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
  scene->meshes.push_back(floor);
  scene->objects.push_back({0, SE3(), 0});
  auto surface = std::make_shared<test::RectFloor>(std::vector<test::PaintedRect>{});
  surface->base.setZero();
  scene->floor = surface;
  Luminaire lamp;
  lamp.end_a << 0.0F, 0.0F, 3.0F;
  lamp.end_b = lamp.end_a;
  lamp.flux_lm = 1000.0F;
  scene->luminaires.push_back(lamp);
  Renderer renderer(scene, RenderOptions{});
  const BakedLight& light = renderer.light();
  const double scale = light.raw_floor_lux / light.mean_floor_lux;
  for (const float x : {0.05F, 1.05F, 3.05F, 5.05F}) {
    const std::size_t cell = light.floor_grid.index(x, 0.05F);
    const double d2 = x * x + 0.05 * 0.05 + 9.0;
    const double expected = 0.88 * 1000.0 / M_PI * 9.0 / (d2 * d2);
    EXPECT_NEAR(luminance(light.floor[cell].lux) * scale, expected, 0.01 * expected) << x;
  }
}

TEST(Renderer, ShowsWhatMoves) {
  Renderer renderer(busyHall(), RenderOptions{});
  const int camera = renderer.addCamera(smallCamera());
  const SE3 pose = test::lookAlongX(0.2);
  const auto count = [&](double t, const std::optional<SE3>& ego, int instance) {
    const TruthImages truth = renderer.renderTruth(camera, pose, *renderer.moment(t, ego));
    int pixels = 0;
    for (int i = 0; i < truth.instances.rows * truth.instances.cols; ++i) {
      pixels += truth.instances.at<std::int32_t>(i) == instance ? 1 : 0;
    }
    return pixels;
  };
  EXPECT_GT(count(0.0, std::nullopt, 77), 300);
  EXPECT_LT(count(6.0, std::nullopt, 77), count(0.0, std::nullopt, 77));
  EXPECT_EQ(count(0.0, std::nullopt, -1), 0);
  EXPECT_GT(count(0.0, SE3(SO3(), {-3.0, 0.0, 0.0}), -1), 300);
}

TEST(Renderer, FloorMirrorsTheWall) {
  auto scene = test::makeHall(paint());
  RenderOptions on;
  on.sensor.noise = false;
  RenderOptions off = on;
  off.reflections = false;
  Renderer with(scene, on);
  Renderer without(scene, off);
  with.addCamera(smallCamera());
  without.addCamera(smallCamera());
  const SE3 pose = test::lookAlongX(0.05);
  const Radiance a = with.renderRadiance(0, pose, *with.moment(0.0, std::nullopt));
  const Radiance b = without.renderRadiance(0, pose, *without.moment(0.0, std::nullopt));
  double far = 0.0;
  double near = 0.0;
  for (int x = 100; x < 220; ++x) {
    far += luminance(a.pixels[118 * 320 + x]) / luminance(b.pixels[118 * 320 + x]) / 120.0;
    near += luminance(a.pixels[195 * 320 + x]) / luminance(b.pixels[195 * 320 + x]) / 120.0;
  }
  EXPECT_GT(far, 1.05);  // grazing: Fresnel
  EXPECT_GT(far, near);
}

TEST(Renderer, OrthoTruthIsMetric) {
  Renderer renderer(busyHall(), RenderOptions{});
  // At x = 1, heading along y: row 0 lies ahead (+y), column 0 to the left (-x).
  const SE3 pose(SO3::fromYawPitchRoll(M_PI / 2, 0.02, 0.01), {1.0, -2.0, 0.0});
  const OrthoImages ortho = renderer.renderOrtho(pose, 201, 0.05, 0.0);
  const auto labelAt = [&](double x, double y) {
    const int row = static_cast<int>(std::lround(100.0 - (y + 2.0) / 0.05));
    const int column = static_cast<int>(std::lround(100.0 + (x - 1.0) / 0.05));
    return static_cast<SemanticClass>(ortho.labels.at<std::uint8_t>(row, column));
  };
  EXPECT_EQ(labelAt(1.0, -0.92), SemanticClass::kSlotLine);
  EXPECT_EQ(labelAt(1.0, -0.75), SemanticClass::kFloor);
  EXPECT_EQ(labelAt(1.0, -1.1), SemanticClass::kFloor);
  EXPECT_EQ(labelAt(4.3, 1.8), SemanticClass::kPillar);
  EXPECT_EQ(labelAt(3.0, -4.5), SemanticClass::kVehicle);
  EXPECT_EQ(labelAt(1.2, 2.5), SemanticClass::kVehicle);  // the moving one
}

TEST(Renderer, MotionBlurSmearsAlongTheMotion) {
  RenderOptions options;
  options.sensor.noise = false;
  options.sensor.motion_blur = 8;
  options.sensor.fixed_exposure_ms = 20.0;
  options.sensor.fixed_gain = 2.0;
  Renderer renderer(test::makeHall(paint()), options);
  renderer.addCamera(smallCamera());
  // The steepest step along a row that crosses the pillar's vertical edges, on the wall behind it.
  const auto steepest = [&](double yaw_rate) {
    CameraMotion motion;
    motion.T_world_vehicle = [yaw_rate](double t) {
      return SE3(SO3::fromYawPitchRoll(yaw_rate * t, 0.0, 0.0), {-2.0, 0.0, 0.0});
    };
    motion.T_vehicle_cam = SE3(test::lookAlongX(0.0).rotation(), {0.0, 0.0, 1.2});
    const cv::Mat image = renderer.render(0, motion, 0.0, 0);
    int most = 0;
    for (int x = 1; x < image.cols; ++x) {
      most = std::max(most,
                      std::abs(image.at<cv::Vec3b>(99, x)[2] - image.at<cv::Vec3b>(99, x - 1)[2]));
    }
    return most;
  };
  EXPECT_GT(steepest(0.0), 20);
  EXPECT_LT(steepest(3.0), 0.6 * steepest(0.0));  // 3 rad/s, 20 ms, 135 px/rad: 8 px
}

TEST(Renderer, RollingShutterReadsEachRowFromWhereTheCameraIsThen) {
  Renderer renderer(busyHall(), RenderOptions{});
  renderer.addCamera(smallCamera());
  CameraMotion motion;
  motion.T_world_vehicle = [](double t) {
    return SE3(SO3::fromYawPitchRoll(0.5 * t, 0.0, 0.0), {-2.0 + 4.0 * t, 0.0, 0.0});
  };
  motion.T_vehicle_cam = SE3(test::lookAlongX(0.0).rotation(), {0.0, 0.0, 1.2});
  motion.readout_time = 0.2;
  const auto moment = renderer.moment(0.0, std::nullopt);
  const TruthImages rolling = renderer.renderTruth(0, renderer.placesOf(0, motion, 0.0), *moment);
  const int rows = rolling.depths.rows;
  cv::Mat at_once;
  for (const int row : {0, rows / 3, rows - 1}) {
    const double t = rowTimeOf(motion.readout_time, row, rows);
    const SE3 there = motion.T_world_vehicle(t) * motion.T_vehicle_cam;
    at_once = renderer.renderTruth(0, there, *moment).depths;
    EXPECT_EQ(cv::norm(rolling.depths.row(row), at_once.row(row), cv::NORM_INF), 0.0) << row;
  }
  // Of the last row's place; the wall before the car has come nearer by then.
  EXPECT_GT(cv::norm(rolling.depths.row(rows / 3), at_once.row(rows / 3), cv::NORM_INF), 0.1);
}

TEST(Renderer, RollingShutterLeavesTheOwnCarInItsPlace) {
  auto scene = busyHall();
  Renderer renderer(scene, RenderOptions{});
  renderer.addCamera(smallCamera());
  CameraMotion motion;
  motion.T_world_vehicle = [](double t) { return SE3(SO3(), {-2.0 + 4.0 * t, 0.0, 0.0}); };
  motion.T_vehicle_cam = SE3(test::lookAlongX(0.5).rotation(), {-0.6, 0.0, 1.7});
  const auto own = [&](double readout_time) {
    motion.readout_time = readout_time;
    const TruthImages truth = renderer.renderTruth(
        0, renderer.placesOf(0, motion, 0.0), *renderer.moment(0.0, motion.T_world_vehicle(0.0)));
    return cv::Mat(truth.instances == -1);
  };
  const cv::Mat at_once = own(0.0);
  EXPECT_GT(cv::countNonZero(at_once), 100);
  EXPECT_EQ(cv::norm(own(0.2), at_once, cv::NORM_INF), 0.0);
}

TEST(Renderer, RefusesASceneWithoutFloorOrLamp) {
  auto dark = test::makeHall(paint());
  dark->luminaires.clear();
  EXPECT_THROW(Renderer(dark, RenderOptions{}), CheckError);
  EXPECT_THROW(Renderer(std::make_shared<Scene>(), RenderOptions{}), CheckError);
}

}  // namespace
}  // namespace parkade::sim
