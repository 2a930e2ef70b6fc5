// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "parkade/geometry/se3.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade::sim {

// What the renderer draws: triangles, materials, light. Made from a Garage by the world builder.
// Colours are linear RGB reflectances (0 to 1); textures are stored as sRGB bytes.

struct Texture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< sRGB, row 0 at v = 0; repeats
};

struct Material {
  std::string name;
  SemanticClass label = SemanticClass::kUnknown;
  Eigen::Vector3f albedo = Eigen::Vector3f::Constant(0.5F);  ///< multiplies the texture
  int texture = -1;                                          ///< index, or -1
  float specular = 0.04F;  ///< mirror reflectance at normal incidence (Schlick)
  float roughness = 0.8F;  ///< 0 mirror .. 1 dull
  Eigen::Vector3f emission = Eigen::Vector3f::Zero();  ///< radiance, relative to 1 lux floor
  bool is_floor = false;  ///< shaded by Scene::floor at the hit's (x, y)
};

struct Triangle {
  std::uint32_t v[3] = {0, 0, 0};
  std::uint16_t material = 0;
};

struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector2f> uvs;      ///< one per vertex, or empty
  std::vector<Eigen::Vector3f> normals;  ///< one per vertex (smooth), or empty (flat)
  std::vector<Triangle> triangles;
};

/// A mesh standing still at its place.
struct StaticObject {
  int mesh = 0;
  SE3 T_world_mesh;
  std::uint32_t instance = 0;  ///< id of the object for instance label images; 0 is structure
};

/// A car or person that moves. The mesh to show may change with the phase of a gait.
struct MovingObject {
  std::uint32_t instance = 0;
  SemanticClass label = SemanticClass::kVehicle;
  Eigen::Vector3d box_size = Eigen::Vector3d::Zero();  ///< m; stands on its origin, x forward
  std::function<SE3(double t)> pose;                   ///< T_world_object at t seconds
  std::function<int(double t)> mesh;                   ///< index into Scene::meshes at t
  bool head_lamps = false;
};

/// A fluorescent or LED tube, or a lamp when both ends coincide.
struct Luminaire {
  Eigen::Vector3f end_a = Eigen::Vector3f::Zero();
  Eigen::Vector3f end_b = Eigen::Vector3f::Zero();
  float flux_lm = 3000.0F;  ///< emitted downwards, cosine lobe
  Eigen::Vector3f colour = Eigen::Vector3f::Ones();
  float flicker_hz = 0.0F;     ///< 0: steady
  float flicker_depth = 0.0F;  ///< 0..1
};

/// The floor's look at one place, averaged over a footprint.
struct FloorSample {
  Eigen::Vector3f albedo = Eigen::Vector3f::Constant(0.3F);
  float specular = 0.04F;
  float roughness = 0.3F;
  SemanticClass label = SemanticClass::kFloor;
};

/// Groups of neighbouring places on the floor, asked for together.
struct FloorBlock {
  static constexpr int kGroups = 16;
  static constexpr int kPoints = 16;  ///< of a group, at most
  int count = 0;                      ///< groups, at least 1
  /// Group i has the points from first[i] to first[i + 1], at least one.
  std::array<int, kGroups + 1> first{};
  alignas(64) std::array<float, kGroups> footprint;
  std::array<float, kGroups * kPoints> x;
  std::array<float, kGroups * kPoints> y;
};

/// What the floor looks like in each group of a FloorBlock.
struct FloorLooks {
  alignas(64) std::array<float, FloorBlock::kGroups> red;
  std::array<float, FloorBlock::kGroups> green;
  std::array<float, FloorBlock::kGroups> blue;
  std::array<float, FloorBlock::kGroups> specular;
  std::array<float, FloorBlock::kGroups> roughness;
};

/// Floor texture with all paint, wear, stains, tyre marks. Thread-safe and fast: called per ray.
class FloorSurface {
 public:
  virtual ~FloorSurface() = default;
  /// The footprint is the diameter in metres of the disc to average over.
  [[nodiscard]] virtual FloorSample sample(float x, float y, float footprint) const = 0;
  /// The mean over count neighbouring places (at least 1), each averaged over the footprint; its
  /// label is of no use.
  [[nodiscard]] virtual FloorSample mean(const float* x, const float* y, int count,
                                         float footprint) const;
  /// mean() of every group of a block.
  virtual void means(const FloorBlock& block, FloorLooks& out) const;
};

struct Scene {
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<StaticObject> objects;
  std::vector<MovingObject> moving;
  std::vector<Luminaire> luminaires;
  std::shared_ptr<const FloorSurface> floor;
  int ego_mesh = -1;  ///< mesh of the own car's body in the vehicle frame; -1: none is drawn
  double target_floor_lux = 200.0;  ///< mean over the drivable floor that the bake must meet
  /// Daylight through an opening: direction to the sky's centre and its share of the light.
  struct Daylight {
    bool present = false;
    Eigen::Vector3f center = Eigen::Vector3f::Zero();   ///< of the opening
    Eigen::Vector3f normal = Eigen::Vector3f::UnitX();  ///< into the garage
    float width = 5.0F;
    float height = 2.4F;
    float luminous_exitance = 2000.0F;  ///< lm/m^2
  } daylight;
};

}  // namespace parkade::sim
