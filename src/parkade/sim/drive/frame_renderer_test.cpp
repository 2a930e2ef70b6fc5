// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/frame_renderer.hpp"

#include <gtest/gtest.h>

#include <string>

namespace parkade::sim {
namespace {

const std::string kDrive = "sim:random?garage_seed=5003&seed=5003";

std::shared_ptr<const Scene> sceneOf(const std::string& address) {
  const auto simulation = Simulation::make(parseSimAddress(address).value()).value();
  return makeScene(*simulation);
}

TEST(MakeScene, ACutDriveMeetsWhomTheWholeOneMeets) {
  for (const std::string start : {"", "&rolling_start=1"}) {
    SCOPED_TRACE(start);
    const std::string address = kDrive + "&cars=3&people=4" + start;
    const auto whole = sceneOf(address);
    const auto cut = sceneOf(address + "&duration=6");
    ASSERT_FALSE(whole->moving.empty());
    ASSERT_EQ(cut->moving.size(), whole->moving.size());
    for (std::size_t i = 0; i < whole->moving.size(); ++i) {
      const MovingObject& a = whole->moving[i];
      const MovingObject& b = cut->moving[i];
      EXPECT_EQ(a.label, b.label);
      EXPECT_EQ(a.box_size, b.box_size);
      for (double t = 0.0; t <= 6.0; t += 0.5) {
        EXPECT_EQ(a.pose(t).matrix(), b.pose(t).matrix()) << "t = " << t;
        EXPECT_EQ(a.mesh(t), b.mesh(t)) << "t = " << t;
      }
    }
  }
}

// Embree ended the program while it built the tree of this one's triangles.
TEST(MakeScene, AGarageThatSplitTrianglesBadlyIsDrawn) {
  const auto scene = sceneOf("sim:random?garage_seed=4823&seed=4824&occupancy=0.85&duration=1");
  RenderOptions options;
  options.bake.floor_cell = 1.0;
  options.bake.indirect_cell = 2.0;
  options.bake.gather_rays = 16;
  options.bake.bounces = 1;
  const Renderer renderer(scene, options);
  EXPECT_GT(scene->objects.size(), 20U);
}

/// The parked cars: their places, by slot.
std::vector<std::pair<std::uint32_t, Eigen::Vector3d>> parkedIn(const Scene& scene) {
  std::vector<std::pair<std::uint32_t, Eigen::Vector3d>> parked;
  for (const StaticObject& object : scene.objects) {
    if (object.instance != 0) {
      parked.emplace_back(object.instance, object.T_world_mesh.translation());
    }
  }
  return parked;
}

TEST(MakeScene, AnotherParkedSeedShowsOtherCarsInTheSameBuilding) {
  const std::string address = kDrive + "&cars=0&people=0&duration=1";
  const auto usual = sceneOf(address);
  const auto same = sceneOf(address + "&parked_seed=5003");
  const auto later = sceneOf(address + "&parked_seed=5004");
  EXPECT_EQ(parkedIn(*same), parkedIn(*usual));
  EXPECT_NE(parkedIn(*later), parkedIn(*usual));
  EXPECT_EQ(parkedIn(*later).size(), parkedIn(*usual).size());
  EXPECT_EQ(later->meshes.front().vertices, usual->meshes.front().vertices);
  ASSERT_EQ(later->luminaires.size(), usual->luminaires.size());
  for (float x = 1.0F; x < 30.0F; x += 0.37F) {
    EXPECT_EQ(later->floor->sample(x, 12.3F, 0.02F).albedo,
              usual->floor->sample(x, 12.3F, 0.02F).albedo);
  }
}

}  // namespace
}  // namespace parkade::sim
