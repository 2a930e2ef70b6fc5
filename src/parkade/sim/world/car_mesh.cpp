// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/car_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "parkade/sim/world/car_hull.hpp"
#include "parkade/sim/world/car_profile.hpp"
#include "parkade/sim/world/mesh_builder.hpp"

namespace parkade::sim {
namespace {

// Lamps that wrap around the corners, plates, door handles' line and mirrors.
void addDetails(MeshBuilder& builder, const CarProfile& profile, const CarSize& size,
                const CarMaterials& materials) {
  const auto length = static_cast<float>(size.length);
  const auto height = static_cast<float>(size.height);
  const auto lamp = [&](float s0, float s1, std::uint16_t material, float drop) {
    const auto a = crossSection(profile, size, s0);
    const auto b = crossSection(profile, size, s1);
    constexpr float kProud = 0.006F;
    for (const float side : {1.0F, -1.0F}) {
      const auto at = [&](const auto& section, float s, float z) {
        float y = section[5].x();
        for (std::size_t k = 2; k + 1 < kSidePoints; ++k) {
          if (section[k].y() <= z && section[k + 1].y() >= z) {
            const float rise = std::max(1e-4F, section[k + 1].y() - section[k].y());
            y = section[k].x() +
                (section[k + 1].x() - section[k].x()) * (z - section[k].y()) / rise;
          }
        }
        return Eigen::Vector3f(length * (0.5F - s), side * (y + kProud), z);
      };
      const float high = std::min(a[kBeltPoint].y(), b[kBeltPoint].y()) - 0.02F;
      const Eigen::Vector3f p00 = at(a, s0, high - drop);
      const Eigen::Vector3f p10 = at(b, s1, high - drop);
      const Eigen::Vector3f p11 = at(b, s1, high);
      const Eigen::Vector3f p01 = at(a, s0, high);
      if (side > 0.0F) {
        builder.quad(p00, p10, p11, p01, material);
      } else {
        builder.quad(p10, p00, p01, p11, material);
      }
    }
  };
  lamp(0.012F, 0.07F, materials.head_lamp, 0.12F);
  lamp(0.95F, 0.992F, materials.tail_lamp, 0.16F);

  for (const bool nose : {true, false}) {
    const float x = (nose ? 0.5F : -0.5F) * length + (nose ? 0.008F : -0.008F);
    const float z = nose ? 0.42F : 0.52F * height;
    const float y = nose ? 0.26F : -0.26F;
    builder.quad({x, -y, z - 0.055F}, {x, y, z - 0.055F}, {x, y, z + 0.055F}, {x, -y, z + 0.055F},
                 materials.plate);
  }
  const float mirror_s = profile.screen_low + 0.065F;
  const float belt = height * profile.belt(mirror_s);
  const float side = 0.5F * static_cast<float>(size.width);
  for (const float sign : {1.0F, -1.0F}) {
    builder.ellipsoid({length * (0.5F - mirror_s), sign * (side + 0.07F), belt + 0.06F},
                      {0.06F, 0.11F, 0.075F}, 6, 8, materials.paint);
  }
}

void addWheels(MeshBuilder& builder, const CarProfile& profile, const CarSize& size,
               const CarMaterials& materials) {
  const auto length = static_cast<float>(size.length);
  const float side = 0.5F * static_cast<float>(size.width);
  const float r = profile.wheel_radius;
  constexpr int kSides = 20;
  for (const float share : {profile.front_axle, profile.rear_axle}) {
    for (const float sign : {1.0F, -1.0F}) {
      const Eigen::Vector3f hub(length * (0.5F - share), 0.0F, r);
      const auto at = [&](float y) { return Eigen::Vector3f(hub.x(), sign * y, hub.z()); };
      // The arch: a dark disc just outside the body's side, cut off at the sill.
      std::vector<Eigen::Vector3f> arch;
      for (int i = 0; i <= kSides; ++i) {
        const float angle =
            3.1416F * static_cast<float>(i) / kSides * sign + (sign < 0 ? 3.1416F : 0);
        arch.emplace_back(hub.x() + sign * (r + 0.06F) * std::cos(angle) * sign,
                          sign * (side + 0.002F),
                          hub.z() - 0.06F + (r + 0.08F) * std::abs(std::sin(angle)));
      }
      if (sign > 0.0F) std::reverse(arch.begin(), arch.end());
      builder.polygon(arch, materials.trim);
      builder.cone(at(side - 0.20F), at(side - 0.01F), r, r, kSides, materials.tyre);
      builder.cone(at(side - 0.01F), at(side + 0.012F), r, r - 0.05F, kSides, materials.tyre);
      builder.cone(at(side + 0.0F), at(side + 0.016F), 0.66F * r, 0.62F * r, kSides, materials.rim);
      // Spokes: dark gaps on the rim.
      for (int i = 0; i < 5; ++i) {
        const float angle = 6.2832F * static_cast<float>(i) / 5.0F;
        const Eigen::Vector3f out(std::cos(angle), 0.0F, std::sin(angle));
        const Eigen::Vector3f along(-out.z(), 0.0F, out.x());
        const Eigen::Vector3f c = at(side + 0.018F) + 0.40F * r * out;
        const Eigen::Vector3f a = 0.15F * r * out;
        const Eigen::Vector3f b = 0.09F * r * along;
        if (sign < 0.0F) {
          builder.quad(c - a - b, c + a - 1.6F * b, c + a + 1.6F * b, c - a + b, materials.trim);
        } else {
          builder.quad(c - a + b, c + a + 1.6F * b, c + a - 1.6F * b, c - a - b, materials.trim);
        }
      }
    }
  }
}

std::uint16_t addMaterial(Scene& scene, const char* name, const Eigen::Vector3f& albedo,
                          float specular, float roughness) {
  Material material;
  material.name = name;
  material.label = SemanticClass::kVehicle;
  material.albedo = albedo;
  material.specular = specular;
  material.roughness = roughness;
  scene.materials.push_back(material);
  return static_cast<std::uint16_t>(scene.materials.size() - 1);
}

Mesh buildCar(const CarProfile& profile, const CarSize& size, const CarMaterials& materials) {
  MeshBuilder hull;
  addHull(hull, profile, size, materials);
  addEnd(hull, profile, size, materials, true);
  addEnd(hull, profile, size, materials, false);
  Mesh smooth = hull.take();
  constexpr float kCrease = 0.6F;
  smoothNormals(smooth, kCrease);
  MeshBuilder car;
  car.append(smooth, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero());
  addDetails(car, profile, size, materials);
  addWheels(car, profile, size, materials);
  return car.take();
}

}  // namespace

CarSize typicalSize(CarBody body) {
  switch (body) {
    case CarBody::kSedan:
      return {4.75, 1.84, 1.45};
    case CarBody::kHatchback:
      return {4.30, 1.79, 1.47};
    case CarBody::kEstate:
      return {4.75, 1.84, 1.49};
    case CarBody::kSuv:
      return {4.60, 1.87, 1.68};
    case CarBody::kVan:
      return {5.00, 1.93, 1.94};
    case CarBody::kSmall:
      break;
  }
  return {3.65, 1.64, 1.50};
}

CarMaterials addCarMaterials(Scene& scene) {
  CarMaterials m;
  m.glass = addMaterial(scene, "car glass", {0.012F, 0.015F, 0.016F}, 0.08F, 0.05F);
  m.trim = addMaterial(scene, "car trim", {0.018F, 0.018F, 0.019F}, 0.04F, 0.6F);
  m.tyre = addMaterial(scene, "tyre", {0.022F, 0.022F, 0.023F}, 0.03F, 0.9F);
  m.rim = addMaterial(scene, "rim", {0.42F, 0.43F, 0.44F}, 0.25F, 0.3F);
  m.head_lamp = addMaterial(scene, "head lamp", {0.62F, 0.65F, 0.68F}, 0.10F, 0.1F);
  m.tail_lamp = addMaterial(scene, "tail lamp", {0.38F, 0.015F, 0.012F}, 0.08F, 0.15F);
  m.plate = addMaterial(scene, "plate", {0.72F, 0.72F, 0.68F}, 0.05F, 0.4F);
  return m;
}

std::uint16_t addCarPaint(Scene& scene, const Eigen::Vector3f& colour, bool metallic) {
  return addMaterial(scene, "car paint", colour, metallic ? 0.10F : 0.06F, metallic ? 0.2F : 0.1F);
}

Mesh makeCarMesh(CarBody body, const CarSize& size, const CarMaterials& materials) {
  return buildCar(carProfile(body), size, materials);
}

Mesh egoCarMesh(const VehicleShape& shape, const CarMaterials& materials) {
  const double length = shape.wheelbase + shape.front_overhang + shape.rear_overhang;
  CarProfile profile = carProfile(CarBody::kSedan);
  profile.front_axle = static_cast<float>(shape.front_overhang / length);
  profile.rear_axle = static_cast<float>(1.0 - shape.rear_overhang / length);
  Mesh mesh = buildCar(profile, {length, shape.width, shape.height}, materials);
  const auto shift = static_cast<float>(0.5 * length - shape.rear_overhang);
  for (Eigen::Vector3f& v : mesh.vertices) v.x() += shift;
  return mesh;
}

}  // namespace parkade::sim
