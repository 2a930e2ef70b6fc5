// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/sim/render/light_bake.hpp"

namespace parkade::sim {

// The steps of bakeLight: places (bake_places.cpp), bounces (bake_bounces.cpp), probes
// (bake_probes.cpp), joined in light_bake.cpp.

inline constexpr std::uint32_t kFloorHit = 0x80000000U;  ///< marks floor cells in GatherHit

/// A point that light is computed for.
struct Place {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  bool used = false;
};

/// What a gather ray met: a triangle and where on it, or a floor cell.
struct GatherHit {
  std::uint32_t target = kNoTriangle;
  std::uint8_t u = 0;
  std::uint8_t v = 0;
};

/// Van der Corput's sequence in base 2.
float radicalInverse(std::uint32_t i);

/// How a triangle gets its light.
enum class Kind : std::uint8_t {
  kStructure,  ///< per vertex
  kVehicle,    ///< from the probes: cars have too many vertices
  kFloor,      ///< from the floor's map
  kLamp,       ///< not at all
};

class Baker {
 public:
  Baker(const Scene& scene, const StaticTracer& tracer, const BakeOptions& options, int threads);
  BakedLight bake();

 private:
  [[nodiscard]] Kind kindOf(const RenderTriangle& t) const { return kind_of_material_[t.material]; }
  void lightVehicles(BakedLight& out) const;
  void layFloor(FloorGrid& grid, float cell) const;
  /// Heights and normals of the floor at cell centres; unused where there is no floor.
  [[nodiscard]] std::vector<Place> floorPlaces(const FloorGrid& grid) const;
  [[nodiscard]] std::vector<Place> vertexPlaces() const;
  [[nodiscard]] std::vector<BakedPoint> directAt(const std::vector<Place>& places,
                                                 std::uint64_t seed) const;
  void gatherHits(const std::vector<Place>& places);
  [[nodiscard]] std::vector<Eigen::Vector3f> bounce(const std::vector<Eigen::Vector3f>& lux) const;
  [[nodiscard]] Eigen::Vector3f bounced(const GatherHit& hit,
                                        const std::vector<Eigen::Vector3f>& lux) const;
  void smooth(std::vector<Eigen::Vector3f>& lux) const;
  void bakeProbes(BakedLight& out, const std::vector<Eigen::Vector3f>& lux) const;
  [[nodiscard]] double openFloorLux(const std::vector<Place>& places,
                                    const std::vector<BakedPoint>& floor) const;

  const Scene& scene_;
  const StaticTracer& tracer_;
  const BakeOptions& options_;
  const int threads_;
  const DirectLight direct_;
  const std::size_t vertex_count_;
  std::vector<Eigen::Vector3f> albedo_of_material_;
  std::vector<Kind> kind_of_material_;
  Eigen::Vector3f usual_lux_ = Eigen::Vector3f::Zero();  ///< mean direct light on the floor
  FloorGrid coarse_;
  std::vector<Place> coarse_places_;
  std::vector<Eigen::Vector3f> coarse_albedo_;
  std::vector<GatherHit> hits_;
};

}  // namespace parkade::sim
