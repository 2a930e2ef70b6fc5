// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/person_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parkade/sim/world/mesh_builder.hpp"

namespace parkade::sim {
namespace {

struct PersonMaterials {
  std::uint16_t skin = 0;
  std::uint16_t hair = 0;
  std::uint16_t top = 0;
  std::uint16_t trousers = 0;
  std::uint16_t shoes = 0;
};

std::uint16_t addCloth(Scene& scene, const char* name, const Eigen::Vector3f& colour) {
  Material material;
  material.name = name;
  material.label = SemanticClass::kPedestrian;
  material.albedo = colour;
  material.specular = 0.02F;
  material.roughness = 0.95F;
  scene.materials.push_back(material);
  return static_cast<std::uint16_t>(scene.materials.size() - 1);
}

constexpr int kSides = 9;

// A limb of two parts with a rounded joint, swinging in the x-z plane: angles from straight down,
// forwards positive.
struct Limb {
  Eigen::Vector3f root;
  float upper_length;
  float lower_length;
  float upper_angle;
  float lower_angle;

  [[nodiscard]] Eigen::Vector3f joint() const { return root + along(upper_angle, upper_length); }
  [[nodiscard]] Eigen::Vector3f end() const { return joint() + along(lower_angle, lower_length); }

 private:
  static Eigen::Vector3f along(float angle, float length) {
    return {length * std::sin(angle), 0.0F, -length * std::cos(angle)};
  }
};

void addLimb(MeshBuilder& builder, const Limb& limb, float r0, float r1, float r2,
             std::uint16_t upper, std::uint16_t lower) {
  builder.ellipsoid(limb.root, Eigen::Vector3f::Constant(r0), 6, kSides, upper);
  builder.cone(limb.root, limb.joint(), r0, r1, kSides, upper, false);
  builder.ellipsoid(limb.joint(), Eigen::Vector3f::Constant(r1), 4, kSides, lower);
  builder.cone(limb.joint(), limb.end(), r1, r2, kSides, lower, true);
}

// One body; phase in turns, walking 0 (still) or 1.
Mesh makePerson(const PersonLook& look, const PersonMaterials& m, float phase, float walking) {
  const auto h = static_cast<float>(look.height);
  const auto girth = static_cast<float>(look.girth);
  const float turn = 2.0F * std::numbers::pi_v<float> * phase;
  MeshBuilder builder;
  const float thigh = 0.245F * h;
  const float shank = 0.245F * h;
  // Hips sink when the legs are apart, so that feet stay near the ground.
  const float swing = 0.42F * walking;
  const float hip =
      (thigh + shank) * (1.0F - 0.5F * 0.06F * walking * (1.0F + std::cos(2.0F * turn))) +
      0.035F * h;
  for (const float side : {1.0F, -1.0F}) {
    const float leg = turn + (side < 0.0F ? std::numbers::pi_v<float> : 0.0F);
    const float angle = swing * std::cos(leg);
    // The knee bends while the leg swings forwards.
    const float bend = walking * (0.12F + 0.75F * std::max(0.0F, std::sin(-leg)));
    const Limb limb{{0.0F, side * 0.052F * h, hip}, thigh, shank, angle, angle - bend};
    addLimb(builder, limb, 0.052F * h * girth, 0.034F * h, 0.024F * h, m.trousers, m.trousers);
    const Eigen::Vector3f ankle = limb.end();
    const Eigen::Vector3f foot(ankle.x() + 0.045F * h, ankle.y(),
                               std::max(0.022F * h, ankle.z() - 0.012F * h));
    builder.ellipsoid(foot, {0.078F * h, 0.028F * h, 0.022F * h}, 5, kSides, m.shoes);
  }
  const float shoulder = hip + 0.295F * h;
  const float depth = 0.065F * h * girth;
  const float hip_half = 0.088F * h * girth;
  const float shoulder_half = 0.118F * h;
  const auto torso = [&](float z, float half, float deep) {
    builder.ellipsoid({0.0F, 0.0F, z}, {deep, half, 0.115F * h}, 8, 12, m.top);
  };
  torso(hip + 0.03F * h, hip_half, depth * 1.05F);
  torso(hip + 0.13F * h, 0.5F * (hip_half + shoulder_half), depth);
  torso(hip + 0.22F * h, shoulder_half, depth);
  if (look.skirt_coat) {
    builder.cone({0.0F, 0.0F, hip - 0.22F * h}, {0.0F, 0.0F, hip + 0.08F * h}, 0.135F * h,
                 0.095F * h, 12, m.top, false);
  }
  for (const float side : {1.0F, -1.0F}) {
    const float arm = turn + (side > 0.0F ? std::numbers::pi_v<float> : 0.0F);
    const float angle = 0.45F * walking * std::cos(arm);
    const Limb limb{{0.0F, side * 0.128F * h, shoulder - 0.01F * h},
                    0.17F * h,
                    0.15F * h,
                    angle,
                    angle + 0.12F + 0.2F * walking};
    addLimb(builder, limb, 0.034F * h * girth, 0.027F * h, 0.020F * h, m.top, m.top);
    builder.ellipsoid(limb.end() - Eigen::Vector3f(0, 0, 0.03F * h),
                      {0.024F * h, 0.016F * h, 0.042F * h}, 4, kSides, m.skin);
  }
  const float head = h - 0.07F * h;
  builder.cone({0.0F, 0.0F, shoulder}, {0.01F * h, 0.0F, head - 0.03F * h}, 0.032F * h, 0.030F * h,
               kSides, m.skin, false);
  builder.ellipsoid({0.012F * h, 0.0F, head}, {0.052F * h, 0.043F * h, 0.066F * h}, 8, 12, m.skin);
  builder.ellipsoid({-0.006F * h, 0.0F, head + 0.018F * h}, {0.052F * h, 0.047F * h, 0.058F * h}, 8,
                    12, m.hair);
  return builder.take();
}

}  // namespace

double gaitCycleLength(double height) {
  return 0.83 * height;  // two steps of 0.415 of the height each
}

std::vector<int> addPersonMeshes(Scene& scene, const PersonLook& look) {
  PersonMaterials m;
  m.skin = addCloth(scene, "skin", look.skin);
  m.hair = addCloth(scene, "hair", look.hair);
  m.top = addCloth(scene, "top", look.top);
  m.trousers = addCloth(scene, "trousers", look.trousers);
  m.shoes = addCloth(scene, "shoes", look.shoes);
  std::vector<int> meshes;
  for (int phase = 0; phase <= kGaitPhases; ++phase) {
    const bool still = phase == kGaitPhases;
    const float share = still ? 0.25F : static_cast<float>(phase) / kGaitPhases;
    scene.meshes.push_back(makePerson(look, m, share, still ? 0.0F : 1.0F));
    meshes.push_back(static_cast<int>(scene.meshes.size()) - 1);
  }
  return meshes;
}

}  // namespace parkade::sim
