// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/car_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "parkade/sim/world/mesh_builder.hpp"

namespace parkade::sim {
namespace {

struct Box {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9F);
  Eigen::Vector3f high = Eigen::Vector3f::Constant(-1e9F);
};

Box boxOf(const Mesh& mesh) {
  Box box;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    box.low = box.low.cwiseMin(v);
    box.high = box.high.cwiseMax(v);
  }
  return box;
}

// Volume by the divergence theorem: positive where faces look outwards.
double volumeOf(const Mesh& mesh) {
  double volume = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t.v[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t.v[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t.v[2]].cast<double>();
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

void expectSane(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    ASSERT_TRUE(mesh.vertices[i].allFinite());
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t i : t.v) {
      ASSERT_LT(i, mesh.vertices.size());
      ASSERT_NEAR(mesh.normals[i].norm(), 1.0F, 1e-3F);
    }
  }
}

TEST(MeshBuilder, SolidsHaveTheirVolumeAndLookOutwards) {
  MeshBuilder box;
  box.box({1, 2, 3}, {0.5F, 1.0F, 1.5F}, 0, 0.4F);
  EXPECT_NEAR(volumeOf(box.mesh()), 6.0, 1e-4);
  MeshBuilder cylinder;
  cylinder.cone({1, 0, 0}, {1, 2, 0}, 0.5F, 0.5F, 64, 0);
  EXPECT_NEAR(volumeOf(cylinder.mesh()), 1.568, 1e-2);
  MeshBuilder ball;
  ball.ellipsoid({0, 0, 4}, {1, 1, 2}, 32, 48, 0);
  EXPECT_NEAR(volumeOf(ball.mesh()), 8.378, 0.1);
  for (const Mesh* mesh : {&box.mesh(), &cylinder.mesh()}) expectSane(*mesh);
  // Corner normals agree with the faces that they shade.
  for (const Triangle& t : ball.mesh().triangles) {
    const auto& v = ball.mesh().vertices;
    const Eigen::Vector3f n = (v[t.v[1]] - v[t.v[0]]).cross(v[t.v[2]] - v[t.v[0]]);
    if (n.norm() > 1e-6F) {
      EXPECT_GT(n.dot(ball.mesh().normals[t.v[1]]), 0.0F);
    }
  }
}

TEST(MeshBuilder, SmoothingKeepsCreasesAndRoundsTheRest) {
  MeshBuilder flat;
  flat.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 0);
  flat.quad({1, 0, 0}, {2, 0, 0.2F}, {2, 1, 0.2F}, {1, 1, 0}, 0);
  flat.quad({0, 1, 0}, {0, 0, 0}, {0, 0, -1}, {0, 1, -1}, 0);
  Mesh mesh = flat.take();
  smoothNormals(mesh, 0.6F);
  EXPECT_LT(mesh.normals[1].x(), -0.05F);         // shared by the two gentle faces
  EXPECT_NEAR(mesh.normals[0].z(), 1.0F, 1e-5F);  // the sharp edge stays
}

TEST(CarMesh, EveryBodyFillsItsBoxStandsOnTheGroundAndIsSolid) {
  Scene scene;
  CarMaterials materials = addCarMaterials(scene);
  materials.paint = addCarPaint(scene, {0.2F, 0.02F, 0.02F}, true);
  for (const CarBody body : kCarBodies) {
    const CarSize size = typicalSize(body);
    const Mesh mesh = makeCarMesh(body, size, materials);
    expectSane(mesh);
    EXPECT_GT(mesh.triangles.size(), 2000U);
    EXPECT_LT(mesh.triangles.size(), 5000U);
    const Box box = boxOf(mesh);
    EXPECT_NEAR(box.low.z(), 0.0F, 0.01F);
    EXPECT_NEAR(box.high.z(), static_cast<float>(size.height), 0.02F);
    EXPECT_NEAR(box.high.x() - box.low.x(), static_cast<float>(size.length), 0.04F);
    EXPECT_NEAR(box.high.y() + box.low.y(), 0.0F, 1e-4F);
    EXPECT_LT(box.high.y(), static_cast<float>(0.5 * size.width) + 0.2F);  // with mirrors
    const double filled = volumeOf(mesh) / (size.length * size.width * size.height);
    EXPECT_GT(filled, 0.5);
    EXPECT_LT(filled, 0.9);
    for (const Triangle& t : mesh.triangles) ASSERT_LT(t.material, scene.materials.size());
  }
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.label, SemanticClass::kVehicle);
  }
}

TEST(CarMesh, OwnCarHasItsAxlesWhereTheVehicleFrameSays) {
  Scene scene;
  CarMaterials materials = addCarMaterials(scene);
  materials.paint = addCarPaint(scene, {0.1F, 0.1F, 0.1F}, true);
  const VehicleShape shape;
  const Mesh mesh = egoCarMesh(shape, materials);
  const Box box = boxOf(mesh);
  EXPECT_NEAR(box.low.x(), -shape.rear_overhang, 0.02);
  EXPECT_NEAR(box.high.x(), shape.wheelbase + shape.front_overhang, 0.02);
  Box tyres;
  for (const Triangle& t : mesh.triangles) {
    if (t.material != materials.tyre) continue;
    for (const std::uint32_t i : t.v) {
      tyres.low = tyres.low.cwiseMin(mesh.vertices[i]);
      tyres.high = tyres.high.cwiseMax(mesh.vertices[i]);
    }
  }
  EXPECT_NEAR(tyres.low.x(), -0.325F, 0.01F);
  EXPECT_NEAR(tyres.high.x(), shape.wheelbase + 0.325, 0.01);
}

}  // namespace
}  // namespace parkade::sim
