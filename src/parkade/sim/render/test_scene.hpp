// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "parkade/sim/scene.hpp"

// A small hall for the renderer's tests: known rectangles of paint on a floor, walls, a pillar, a
// box in place of a car, tubes below the ceiling.
namespace parkade::sim::test {

struct PaintedRect {
  Eigen::Vector2f min;
  Eigen::Vector2f max;
  Eigen::Vector3f albedo;
  SemanticClass label;
};

/// Rectangles of paint, averaged by a Gaussian with the standard deviation of the footprint's disc.
class RectFloor : public FloorSurface {
 public:
  explicit RectFloor(std::vector<PaintedRect> rects) : rects_(std::move(rects)) {}
  [[nodiscard]] FloorSample sample(float x, float y, float footprint) const override {
    FloorSample sample;
    sample.albedo = base;
    sample.roughness = roughness;
    const float width = std::numbers::sqrt2_v<float> * std::max(0.25F * footprint, 1e-5F);
    for (const PaintedRect& r : rects_) {
      const auto overlap = [width](float p, float low, float high) {
        return 0.5F * (std::erf((p - low) / width) - std::erf((p - high) / width));
      };
      const float share = overlap(x, r.min.x(), r.max.x()) * overlap(y, r.min.y(), r.max.y());
      sample.albedo += share * (r.albedo - base);
      if (x >= r.min.x() && x <= r.max.x() && y >= r.min.y() && y <= r.max.y()) {
        sample.label = r.label;
      }
    }
    return sample;
  }
  Eigen::Vector3f base = Eigen::Vector3f::Constant(0.25F);
  float roughness = 0.3F;

 private:
  std::vector<PaintedRect> rects_;
};

/// A box from min to max; inward turns its faces to the inside.
inline Mesh makeBox(const Eigen::Vector3f& min, const Eigen::Vector3f& max, std::uint16_t material,
                    bool inward = false) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(),
                               i & 4 ? max.z() : min.z());
  }
  constexpr std::uint32_t kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : kQuads) {
    for (int half = 0; half < 2; ++half) {
      Triangle t;
      t.v[0] = q[0];
      t.v[1] = half == 0 ? q[1] : q[2];
      t.v[2] = half == 0 ? q[2] : q[3];
      if (inward) {
        std::swap(t.v[1], t.v[2]);
      }
      t.material = material;
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

enum TestMaterial : std::uint16_t { kFloorM, kWallM, kCeilingM, kPillarM, kLampM, kCarM };

/// A hall of 20 x 14 m, 2.8 m high, around the origin.
inline std::shared_ptr<Scene> makeHall(std::vector<PaintedRect> rects, double lux = 200.0) {
  auto scene = std::make_shared<Scene>();
  scene->target_floor_lux = lux;
  scene->floor = std::make_shared<RectFloor>(std::move(rects));
  const auto material = [&](SemanticClass label, Eigen::Vector3f albedo) {
    Material m;
    m.label = label;
    m.albedo = albedo;
    scene->materials.push_back(m);
    return &scene->materials.back();
  };
  material(SemanticClass::kFloor, Eigen::Vector3f::Constant(0.25F))->is_floor = true;
  material(SemanticClass::kWall, {0.05F, 0.35F, 0.33F});
  material(SemanticClass::kCeiling, Eigen::Vector3f::Constant(0.6F));
  material(SemanticClass::kPillar, {0.7F, 0.65F, 0.2F});
  material(SemanticClass::kCeiling, Eigen::Vector3f::Constant(0.8F))->emission.setConstant(40.0F);
  Material* car = material(SemanticClass::kVehicle, {0.45F, 0.05F, 0.05F});
  car->roughness = 0.1F;
  const auto add = [&](Mesh mesh, std::uint32_t instance) {
    scene->objects.push_back({static_cast<int>(scene->meshes.size()), SE3(), instance});
    scene->meshes.push_back(std::move(mesh));
  };
  Mesh floor;
  floor.vertices = {{-10, -7, 0}, {10, -7, 0}, {10, 7, 0}, {-10, 7, 0}};
  floor.triangles = {{{0, 1, 2}, kFloorM}, {{0, 2, 3}, kFloorM}};
  add(floor, 0);
  Mesh walls = makeBox({-10, -7, 0}, {10, 7, 2.8F}, kWallM, true);
  for (std::size_t i = 0; i < walls.triangles.size(); ++i) {
    if (i / 2 == 1) {
      walls.triangles[i].material = kCeilingM;
    }
  }
  walls.triangles.erase(walls.triangles.begin(), walls.triangles.begin() + 2);  // its floor
  add(walls, 0);
  add(makeBox({4.0F, 1.5F, 0.0F}, {4.6F, 2.1F, 2.8F}, kPillarM), 1);
  add(makeBox({1.5F, -5.5F, 0.15F}, {6.0F, -3.7F, 1.4F}, kCarM), 2);
  for (const float x : {-7.0F, -2.0F, 3.0F, 8.0F}) {
    for (const float y : {-3.0F, 3.0F}) {
      add(makeBox({x - 0.6F, y - 0.03F, 2.6F}, {x + 0.6F, y + 0.03F, 2.65F}, kLampM), 0);
      Luminaire lamp;
      lamp.end_a << x - 0.6F, y, 2.6F;
      lamp.end_b << x + 0.6F, y, 2.6F;
      scene->luminaires.push_back(lamp);
    }
  }
  return scene;
}

/// A camera 1.2 m up at the hall's left end that looks along x, down by an angle.
inline SE3 lookAlongX(double down_rad) {
  Eigen::Matrix3d R;  // camera x right, y down, z forward
  R.col(2) << std::cos(down_rad), 0.0, -std::sin(down_rad);
  R.col(0) << 0.0, -1.0, 0.0;
  R.col(1) = R.col(2).cross(R.col(0));
  return {SO3(R), {-6.0, 0.0, 1.2}};
}

}  // namespace parkade::sim::test
