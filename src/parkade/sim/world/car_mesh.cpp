// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/car_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "parkade/sim/world/car_profile.hpp"
#include "parkade/sim/world/mesh_builder.hpp"

namespace parkade::sim {
namespace {

constexpr int kSidePoints = 17;  // of half a cross-section, underside to roof

// Half a cross-section at a share of the length: (y, z) from the underside's middle to the roof's.
std::array<Eigen::Vector2f, kSidePoints> crossSection(const CarProfile& profile,
                                                      const CarSize& size, float s) {
  const auto height = static_cast<float>(size.height);
  const float half = 0.5F * static_cast<float>(size.width);
  // The nose and the tail are rounded as seen from above.
  const float nose = std::clamp(s / 0.10F, 0.0F, 1.0F);
  const float tail = std::clamp((1.0F - s) / 0.08F, 0.0F, 1.0F);
  const auto rounded = [](float x, float least) {
    return least + (1.0F - least) * std::sqrt(std::max(0.0F, 1.0F - (1.0F - x) * (1.0F - x)));
  };
  const float w = half * rounded(nose, 0.72F) * rounded(tail, 0.82F);
  const float top = height * profile.top(s);
  const float belt = std::min(height * profile.belt(s), top - 0.03F);
  const float ends = std::min(nose, tail);
  const float bottom = 0.20F + 0.06F * (1.0F - ends);
  const float cabin = std::clamp((top - belt - 0.08F) / (0.25F * height), 0.0F, 1.0F);
  // Outline corners; the roof's edge leans in where there is a cabin.
  const float edge = w * (0.86F - 0.10F * cabin);
  const float edge_z = top - 0.035F - 0.03F * cabin;
  const std::array<Eigen::Vector2f, 8> corner = {
      Eigen::Vector2f(0.0F, bottom),
      Eigen::Vector2f(0.86F * w, bottom),
      Eigen::Vector2f(0.965F * w, bottom + 0.10F),
      Eigen::Vector2f(w, 0.5F * (bottom + belt)),
      Eigen::Vector2f(0.985F * w, belt - 0.05F),
      Eigen::Vector2f(0.955F * w, belt),
      Eigen::Vector2f(edge, std::max(edge_z, belt + 0.01F)),
      Eigen::Vector2f(0.0F, top)};
  constexpr std::array<int, 7> kSteps = {1, 1, 3, 2, 1, 4, 4};
  std::array<Eigen::Vector2f, kSidePoints> points;
  std::size_t at = 0;
  points[at++] = corner[0];
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    for (int k = 1; k <= kSteps[i]; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(kSteps[i]);
      Eigen::Vector2f p = corner[i] + t * (corner[i + 1] - corner[i]);
      if (i == 6) p.y() = edge_z + (top - edge_z) * std::sin(1.5708F * t);  // a crowned roof
      points[at++] = p;
    }
  }
  return points;
}

// Where the ring's steps of the side glass lie: points 8 (belt) to 12 (roof's edge).
constexpr int kBeltPoint = 8;
constexpr int kEdgePoint = 12;

std::uint16_t bodyMaterial(const CarProfile& profile, const CarMaterials& m, float s, int step) {
  const bool side_glass = step >= kBeltPoint && step < kEdgePoint;
  const bool on_top = step >= kEdgePoint;
  if (step < 2) return m.trim;
  if (on_top && step < kSidePoints - 1) {
    if (s > profile.screen_low && s < profile.screen_high) return m.glass;
    if (s > profile.rear_high && s < profile.rear_low) return m.glass;
  }
  if (side_glass && s > profile.screen_low + 0.05F && s < profile.side_end &&
      step > kBeltPoint - 1) {
    constexpr float kPillar = 0.012F;
    const bool pillar =
        std::abs(s - profile.pillar_b) < kPillar || std::abs(s - profile.pillar_c) < kPillar;
    return pillar ? m.trim : m.glass;
  }
  return m.paint;
}

// Shares of the length where cross-sections stand: closer together at both ends and at the edges of
// the windows, so that materials change there.
std::vector<float> stations(const CarProfile& profile) {
  std::vector<float> shares = {0.0F,  0.01F, 0.02F, 0.04F, 0.06F, 0.10F, 0.15F,
                               0.20F, 0.90F, 0.94F, 0.96F, 0.98F, 0.99F, 1.0F};
  for (int i = 1; i < 20; ++i) shares.push_back(0.2F + 0.7F * static_cast<float>(i) / 20.0F);
  for (const float edge : {profile.screen_low, profile.screen_low + 0.05F, profile.screen_high,
                           profile.rear_high, profile.rear_low, profile.side_end}) {
    shares.push_back(edge);
  }
  for (const float pillar : {profile.pillar_b, profile.pillar_c}) {
    shares.push_back(pillar - 0.012F);
    shares.push_back(pillar + 0.012F);
  }
  std::sort(shares.begin(), shares.end());
  std::vector<float> kept;
  for (const float s : shares) {
    if (kept.empty() || s - kept.back() > 0.004F) kept.push_back(s);
  }
  return kept;
}

void addHull(MeshBuilder& builder, const CarProfile& profile, const CarSize& size,
             const CarMaterials& materials) {
  const auto length = static_cast<float>(size.length);
  const std::vector<float> shares = stations(profile);
  const auto place = [&](float s, const Eigen::Vector2f& p, float side) {
    return Eigen::Vector3f(length * (0.5F - s), side * p.x(), p.y());
  };
  for (std::size_t i = 0; i + 1 < shares.size(); ++i) {
    const auto front = crossSection(profile, size, shares[i]);
    const auto rear = crossSection(profile, size, shares[i + 1]);
    const float middle = 0.5F * (shares[i] + shares[i + 1]);
    for (int k = 0; k + 1 < kSidePoints; ++k) {
      const std::uint16_t material = bodyMaterial(profile, materials, middle, k);
      const auto a = static_cast<std::size_t>(k);
      const auto b = a + 1;
      builder.quad(place(shares[i], front[b], 1), place(shares[i], front[a], 1),
                   place(shares[i + 1], rear[a], 1), place(shares[i + 1], rear[b], 1), material);
      builder.quad(place(shares[i], front[a], -1), place(shares[i], front[b], -1),
                   place(shares[i + 1], rear[b], -1), place(shares[i + 1], rear[a], -1), material);
    }
  }
}

// The flat faces of nose and tail, in strips from side to side.
void addEnd(MeshBuilder& builder, const CarProfile& profile, const CarSize& size,
            const CarMaterials& materials, bool nose) {
  const float s = nose ? 0.0F : 1.0F;
  const auto section = crossSection(profile, size, s);
  const float x = static_cast<float>(size.length) * (0.5F - s);
  const float low = section[0].y();
  const float high = section[kSidePoints - 1].y();
  constexpr int kColumns = 10;
  for (std::size_t k = 1; k + 1 < kSidePoints; ++k) {
    const Eigen::Vector2f& a = section[k];
    const Eigen::Vector2f& b = section[k + 1];
    const float level = (0.5F * (a.y() + b.y()) - low) / (high - low);
    for (int c = 0; c < kColumns; ++c) {
      const float u0 = -1.0F + 2.0F * static_cast<float>(c) / kColumns;
      const float u1 = -1.0F + 2.0F * static_cast<float>(c + 1) / kColumns;
      const float across = std::abs(0.5F * (u0 + u1));
      std::uint16_t material = materials.paint;
      if (level < 0.25F || (nose && across < 0.62F && level < 0.62F)) material = materials.trim;
      if (across > 0.60F && level > 0.55F) {
        material = nose ? materials.head_lamp : materials.tail_lamp;
      }
      const Eigen::Vector3f p00(x, u0 * a.x(), a.y());
      const Eigen::Vector3f p10(x, u1 * a.x(), a.y());
      const Eigen::Vector3f p11(x, u1 * b.x(), b.y());
      const Eigen::Vector3f p01(x, u0 * b.x(), b.y());
      if (nose) {
        builder.quad(p00, p10, p11, p01, material);
      } else {
        builder.quad(p10, p00, p01, p11, material);
      }
    }
  }
}

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
