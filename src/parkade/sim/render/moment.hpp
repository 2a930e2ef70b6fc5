// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "parkade/geometry/se3.hpp"
#include "parkade/sim/render/light_bake.hpp"
#include "parkade/sim/render/moment_kernel.hpp"
#include "parkade/sim/render/tracer.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

/// Instance id of the own car in instance images.
inline constexpr std::uint32_t kEgoInstance = 0xffffffffU;

/// A mesh that moves, ready to be placed, with its own tree.
struct ObjectMesh {
  RenderMesh mesh;
  EmbreeScene scene;
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float radius = 0.0F;
  std::vector<Eigen::Vector4f> parts;  ///< small spheres (center, radius) around all of the mesh
  Eigen::Vector3f box_min = Eigen::Vector3f::Zero();
  Eigen::Vector3f box_max = Eigen::Vector3f::Zero();
};

/// An object at one moment.
struct PlacedObject {
  std::shared_ptr<const ObjectMesh> shape;
  Eigen::Matrix3f R_world_object = Eigen::Matrix3f::Identity();
  Eigen::Vector3f p_world = Eigen::Vector3f::Zero();
  Eigen::Vector3f center_world = Eigen::Vector3f::Zero();  ///< of the bounding sphere
  std::vector<Eigen::Vector3f> vertex_lux;
  std::uint32_t instance = 0;
  SemanticClass label = SemanticClass::kVehicle;
  FloorShadow shadow;
};

/// Colour of head lamps.
inline const Eigen::Vector3f kBeamColour(1.0F, 0.97F, 0.9F);

/// Where on the plan head lamps and shadows of objects may reach at all.
struct ReachGrid {
  static constexpr float kCell = 1.0F;  ///< m
  static constexpr std::uint8_t kShadow = 0x80;
  static constexpr std::uint8_t kBeams =
      0x7f;  ///< one bit per beam; the last for all from there on
  /// The bit of a beam.
  static constexpr std::uint8_t bitOf(std::size_t beam) {
    return static_cast<std::uint8_t>(1U << (beam < 6 ? beam : 6));
  }
  Eigen::Vector2f min = Eigen::Vector2f::Zero();
  int nx = 0;
  int ny = 0;
  std::vector<std::uint8_t> cells;  ///< kBeams | kShadow
  /// What may reach a place; outside the grid everything may.
  [[nodiscard]] std::uint8_t at(float x, float y) const {
    const float fx = (x - min.x()) * (1.0F / kCell);
    const float fy = (y - min.y()) * (1.0F / kCell);
    const bool inside =
        fx >= 0.0F && fy >= 0.0F && fx < static_cast<float>(nx) && fy < static_cast<float>(ny);
    return inside ? cells[static_cast<std::size_t>(fy) * nx + static_cast<std::size_t>(fx)]
                  : kBeams | kShadow;
  }
};

/// All that moves, at one time: shared by the cameras of a frame set.
struct Moment {
  double t = 0.0;  ///< s
  std::vector<PlacedObject> objects;
  EmbreeScene scene;                   ///< instance id: index into objects; null without objects
  std::vector<float> lamp_brightness;  ///< per luminaire, 1 where steady; empty: all steady
  std::vector<BeamLight> beams;
  ReachGrid reach_grid;

  /// Whether anything that moves may show in a cone; its half angle in radians.
  [[nodiscard]] bool showsIn(const Eigen::Vector3f& eye, const Eigen::Vector3f& axis,
                             float half_angle) const;
  /// How much of the floor's light the objects leave at kLightLanes places.
  void floorShares(const float* x, const float* y, float* share) const;
  /// Lux of head lamps' light (kBeamColour) at kLightLanes points; reach: what may reach any of
  /// them (ReachGrid).
  void beamLux(unsigned reach, const LightPoints& points, float* lux) const;
};

/// Makes moments; keeps the meshes that it has met. Thread-safe.
class MomentMaker {
 public:
  MomentMaker(const Scene& scene, RTCDevice device, const BakedLight& light,
              const SubdivisionLimits& limits);
  [[nodiscard]] std::shared_ptr<const Moment> make(double t,
                                                   const std::optional<SE3>& T_world_vehicle) const;

 private:
  [[nodiscard]] std::shared_ptr<const ObjectMesh> shapeOf(int mesh) const;
  void markReach(Moment& moment) const;
  void place(Moment& moment, int mesh, const SE3& T_world_object, std::uint32_t instance,
             SemanticClass label) const;

  const Scene& scene_;
  RTCDevice device_;
  const BakedLight& light_;
  SubdivisionLimits limits_;
  mutable std::mutex mutex_;
  mutable std::map<int, std::shared_ptr<const ObjectMesh>> shapes_;
};

}  // namespace parkade::sim
