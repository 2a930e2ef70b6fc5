// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/scene_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "parkade/sim/world/generate.hpp"
#include "parkade/sim/world/parked_cars.hpp"
#include "parkade/sim/world/polygon.hpp"
#include "parkade/sim/world/style.hpp"

namespace parkade::sim {
namespace {

Garage make(const std::string& preset, int seed, double occupancy = 0.6) {
  GarageOptions options;
  options.preset = preset;
  options.seed = seed;
  options.occupancy = occupancy;
  return generateGarage(options).value();
}

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TEST(SceneBuilderTest, TheSameGarageGivesTheSameScene) {
  const Garage garage = make("random", 4);
  const Scene a = buildScene(garage, {});
  const Scene b = buildScene(garage, {});
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_TRUE(sameBytes(a.meshes[i].vertices, b.meshes[i].vertices)) << i;
    EXPECT_TRUE(sameBytes(a.meshes[i].uvs, b.meshes[i].uvs)) << i;
  }
  ASSERT_EQ(a.textures.size(), b.textures.size());
  for (std::size_t i = 0; i < a.textures.size(); ++i) {
    EXPECT_EQ(a.textures[i].rgb, b.textures[i].rgb) << i;
  }
  for (float x = 1.0F; x < 30.0F; x += 0.37F) {
    const FloorSample p = a.floor->sample(x, 12.3F, 0.02F);
    const FloorSample q = b.floor->sample(x, 12.3F, 0.02F);
    EXPECT_EQ(p.albedo, q.albedo);
  }
}

TEST(SceneBuilderTest, EveryOccupiedSlotHoldsACarInsideItsLines) {
  for (const int seed : {1, 8}) {
    const Garage garage = make(seed == 1 ? "paper" : "random", seed, 0.9);
    const Scene scene = buildScene(garage, {});
    for (const Slot& slot : garage.slots) {
      const auto object =
          std::find_if(scene.objects.begin(), scene.objects.end(), [&](const StaticObject& o) {
            return o.instance == kParkedInstance + static_cast<std::uint32_t>(slot.id);
          });
      ASSERT_EQ(object != scene.objects.end(), slot.occupied) << slot.id;
      if (!slot.occupied) continue;
      const Eigen::Vector2d p = object->T_world_mesh.translation().head<2>();
      EXPECT_TRUE(contains({slot.corners.begin(), slot.corners.end()}, p)) << slot.id;
      // Its box leaves every pillar alone.
      Eigen::Vector2d low(1e9, 1e9);
      Eigen::Vector2d high(-1e9, -1e9);
      for (const Eigen::Vector3f& v :
           scene.meshes[static_cast<std::size_t>(object->mesh)].vertices) {
        if (v.z() > 0.9F) continue;  // mirrors reach further
        low = low.cwiseMin(v.head<2>().cast<double>());
        high = high.cwiseMax(v.head<2>().cast<double>());
      }
      const Frame2 at{p, object->T_world_mesh.rotation().yaw()};
      const Polygon body = rectangle(at, low.x(), low.y(), high.x(), high.y());
      for (const Pillar& pillar : garage.pillars) {
        const Eigen::Vector2d half = 0.5 * pillar.size;
        EXPECT_FALSE(convexOverlap(
            body, rectangle({pillar.center, 0.0}, -half.x(), -half.y(), half.x(), half.y())))
            << "slot " << slot.id << " pillar " << pillar.id;
      }
    }
  }
}

TEST(SceneBuilderTest, TheFloorShowsEveryMarkingWhereTheTruthHasIt) {
  const Garage garage = make("paper", 0);
  const std::shared_ptr<const FloorSurface> floor = buildFloor(garage, 0.0, 0.0);
  int checked = 0;
  for (const Marking& marking : garage.markings) {
    if (marking.semantic_class == SemanticClass::kSpeedBump ||
        marking.semantic_class == SemanticClass::kWheelStop ||
        marking.meaning == "accessible_field") {
      continue;
    }
    for (const Polygon& polygon : marking.polygons) {
      Eigen::Vector2d middle = Eigen::Vector2d::Zero();
      for (const Eigen::Vector2d& p : polygon) middle += p / static_cast<double>(polygon.size());
      const auto x = static_cast<float>(middle.x());
      const auto y = static_cast<float>(middle.y());
      const FloorSample sample = floor->sample(x, y, 0.005F);
      EXPECT_EQ(sample.label, marking.semantic_class) << marking.id << " " << marking.meaning;
      EXPECT_LT((sample.albedo - marking.colour).norm(), 0.05F) << marking.id;
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000);
}

/// A random garage whose slots are grey and whose aisles are green.
int seedOfGreenAisles() {
  for (int seed = 0; seed < 400; ++seed) {
    const GarageStyle style = makeStyle("random", static_cast<std::uint64_t>(seed));
    const Eigen::Vector3f& slot = style.slot_floor;
    const Eigen::Vector3f& aisle = style.aisle_floor;
    if (std::abs(slot.y() / slot.x() - 1.0F) < 0.1F && aisle.y() > 2.0F * aisle.x()) return seed;
  }
  return -1;
}

TEST(SceneBuilderTest, AllAislesOfATwoToneFloorEndSoftlyWhereTheyEnd) {
  const int seed = seedOfGreenAisles();
  ASSERT_GE(seed, 0);
  Garage garage = make("random", seed);
  garage.markings.clear();  // the bare floor
  const GarageStyle style = makeStyle(garage.name, garage.seed);
  const Eigen::Vector3f slot = style.slot_floor;
  const Eigen::Vector3f change = style.aisle_floor - style.slot_floor;
  const std::shared_ptr<const FloorSurface> floor = buildFloor(garage, 0.0, 0.0);
  // The aisle's share of the colour; grain and clouds shade both alike.
  const auto share = [&](const Eigen::Vector2d& p) {
    const Eigen::Vector3f albedo =
        floor->sample(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.004F).albedo;
    const float ratio = albedo.y() / albedo.x();
    return (slot.y() - ratio * slot.x()) / (ratio * change.x() - change.y());
  };
  int checked = 0;
  for (const AisleGraph::Edge& edge : garage.aisles.edges) {
    const Eigen::Vector2d a = garage.aisles.nodes[static_cast<std::size_t>(edge.from)];
    const Eigen::Vector2d b = garage.aisles.nodes[static_cast<std::size_t>(edge.to)];
    const Eigen::Vector2d along = (b - a).normalized();
    if ((b - a).norm() < 2.0 * edge.width) continue;  // other aisles are near
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector2d out = side * Eigen::Vector2d(-along.y(), along.x());
      const Eigen::Vector2d border = 0.5 * (a + b) + 0.5 * edge.width * out;
      const Eigen::Vector2d beyond = border + 0.1 * out;
      if (((beyond - garage.min).array() < 0.2).any()) continue;
      if (((garage.max - beyond).array() < 0.2).any()) continue;
      EXPECT_NEAR(share(border - 0.1 * out), 1.0F, 0.03F) << border.transpose();
      EXPECT_NEAR(share(border), 0.5F, 0.2F) << border.transpose();
      EXPECT_NEAR(share(beyond), 0.0F, 0.03F) << border.transpose();
      ++checked;
    }
  }
  EXPECT_GE(checked, 4);
}

TEST(SceneBuilderTest, LampsHangBelowTheCeilingAndMaterialsExist) {
  for (int seed = 0; seed < 3; ++seed) {
    const Garage garage = make("random", seed);
    SceneOptions options;
    options.furniture = seed % 2 == 0;
    EgoInput ego;
    ego.shape = VehicleShape{};
    const Scene scene = buildScene(garage, options, ego);
    EXPECT_GE(scene.ego_mesh, 0);
    ASSERT_FALSE(scene.luminaires.empty());
    for (const Luminaire& lamp : scene.luminaires) {
      EXPECT_LT(lamp.end_a.z(), garage.ceiling_height);
      EXPECT_GT(lamp.end_a.z() - garage.floorHeight(lamp.end_a.head<2>().cast<double>()), 1.9);
      EXPECT_NEAR((lamp.end_a - lamp.end_b).norm(), 1.2, 1e-4);
    }
    for (const Mesh& mesh : scene.meshes) {
      for (const Triangle& t : mesh.triangles) {
        ASSERT_LT(t.material, scene.materials.size());
        for (const std::uint32_t v : t.v) ASSERT_LT(v, mesh.vertices.size());
      }
    }
    for (const Material& material : scene.materials) {
      ASSERT_LT(material.texture, static_cast<int>(scene.textures.size()));
      EXPECT_LT(material.albedo.maxCoeff(), 1.0001F) << material.name;
    }
  }
}

}  // namespace
}  // namespace parkade::sim
