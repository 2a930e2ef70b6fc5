// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/person_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace parkade::sim {
namespace {

TEST(PersonMesh, HasAGaitOfItsHeightOnTheGround) {
  Scene scene;
  PersonLook look;
  look.height = 1.8;
  const std::vector<int> meshes = addPersonMeshes(scene, look);
  ASSERT_EQ(meshes.size(), static_cast<std::size_t>(kGaitPhases + 1));
  for (const int index : meshes) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(index)];
    EXPECT_LT(mesh.triangles.size(), 4000U);
    float low = 1e9F;
    float high = -1e9F;
    for (const Eigen::Vector3f& v : mesh.vertices) {
      low = std::min(low, v.z());
      high = std::max(high, v.z());
    }
    EXPECT_NEAR(low, 0.0F, 0.03F);
    EXPECT_NEAR(high, 1.8F, 0.05F);
  }
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.label, SemanticClass::kPedestrian);
  }
}

TEST(PersonMesh, LegsAreApartAndChangePlaces) {
  Scene scene;
  const std::vector<int> meshes = addPersonMeshes(scene, {});
  // Foremost point below knee height on the left (y > 0) and right side.
  const auto foremost = [&](int phase, float side) {
    float most = -1e9F;
    for (const Eigen::Vector3f& v :
         scene.meshes[static_cast<std::size_t>(meshes[phase])].vertices) {
      if (v.z() < 0.3F && side * v.y() > 0.0F) most = std::max(most, v.x());
    }
    return most;
  };
  EXPECT_GT(foremost(0, 1.0F), foremost(0, -1.0F) + 0.3F);
  EXPECT_GT(foremost(kGaitPhases / 2, -1.0F), foremost(kGaitPhases / 2, 1.0F) + 0.3F);
}

}  // namespace
}  // namespace parkade::sim
