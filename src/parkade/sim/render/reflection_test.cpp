// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/reflection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "parkade/sim/render/renderer.hpp"
#include "parkade/sim/render/test_scene.hpp"

namespace parkade::sim {
namespace {

TEST(MirrorPlace, SpreadsOverThePixelsEvenly) {
  for (const auto& [density, rays] :
       {std::pair{MirrorDensity::kQuarter, 4}, std::pair{MirrorDensity::kEighth, 2}}) {
    std::set<int> places;
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        const int place = mirrorPlace(density, x, y);
        EXPECT_EQ(place, mirrorPlace(density, x + 8, y + 12)) << "repeats every 4 pixels";
        if (place >= 0) {
          places.insert(place);
          EXPECT_TRUE(x % 2 == 0 && y % 2 == 0) << "the buffer has room for no others";
        }
      }
    }
    EXPECT_EQ(static_cast<int>(places.size()), rays);
    EXPECT_EQ(*places.rbegin(), rays - 1);
  }
}

// The foot of a wall with lamps behind it: a mirror ray that starts beyond the wall meets them, and
// bright dots line the wall.
TEST(FloorMirror, SeesNoLampThroughAWall) {
  const auto scene = test::makeHall({});
  constexpr float kWall = -3.0F;  // its near face
  scene->objects.push_back({static_cast<int>(scene->meshes.size()), SE3(), 0});
  Mesh wall;  // a thin face, as the walls of garages are
  wall.vertices = {{kWall, -7, -0.001F}, {kWall, 7, -0.001F}, {kWall, 7, 2.8F}, {kWall, -7, 2.8F}};
  wall.triangles = {{{0, 2, 1}, test::kWallM}, {{0, 3, 2}, test::kWallM}};
  scene->meshes.push_back(wall);
  RenderOptions options;
  options.threads = 1;
  options.bake.bounces = 0;
  Renderer renderer(scene, options);
  options.reflections = false;
  Renderer without(scene, options);
  PinholeRadtan::Parameters p;
  p.fx = p.fy = 300.0;
  p.cx = 159.5;
  p.cy = 119.5;
  const Camera camera(CameraModel(PinholeRadtan(p)), 320, 240);
  const int index = renderer.addCamera(camera);
  without.addCamera(camera);
  const auto moment = renderer.moment(0.0, std::nullopt);
  for (const double back : {0.4, 0.6, 0.9}) {
    Eigen::Matrix3d R;  // camera x right, y down, z forward: at the wall's foot from 1.2 m up
    R.col(2) = Eigen::Vector3d(back, 0.0, -1.2).normalized();
    R.col(0) << 0.0, -1.0, 0.0;
    R.col(1) = R.col(2).cross(R.col(0));
    const SE3 T_world_cam(SO3(R), {kWall - back, 3.0, 1.2});
    const Radiance picture = renderer.renderRadiance(index, T_world_cam, *moment);
    const Radiance plain = without.renderRadiance(index, T_world_cam, *moment);
    const auto mirroredAt = [&](double before_wall) {
      float brightest = 0.0F;
      for (int i = -40; i <= 40; ++i) {
        Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
        EXPECT_TRUE(camera.project(
            T_world_cam.inverse() * Eigen::Vector3d(kWall - before_wall, 3.0 + 0.005 * i, 0.0),
            pixel));
        const auto x = static_cast<int>(std::lround(pixel.x()));
        const auto y = static_cast<int>(std::lround(pixel.y()));
        const auto at = static_cast<std::size_t>(y * picture.width + x);
        brightest = std::max(brightest, (picture.pixels[at] - plain.pixels[at]).maxCoeff());
      }
      return brightest;
    };
    EXPECT_LT(mirroredAt(0.004), 1.5F * mirroredAt(0.08)) << back;
  }
}

}  // namespace
}  // namespace parkade::sim
