// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <vector>

#include "parkade/sim/render/embree.hpp"
#include "parkade/sim/render/render_mesh.hpp"

namespace parkade::sim {

inline constexpr int kPacket = 16;
inline constexpr float kNear = 0.02F;  ///< m: rays start this far from their origin
inline constexpr float kFar = 1.0e4F;  ///< m: beyond anything in a garage
inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr std::uint32_t kNoTriangle = 0xffffffffU;

/// Sixteen rays and what they hit. Lanes with valid 0 are not traced.
struct RayPacket {
  alignas(64) int valid[kPacket];
  RTCRayHit16 rays;

  /// All lanes off, with the mask and the near limit that most rays use, and with rays that are
  /// well formed but end before they begin.
  void clear(unsigned mask);
  void set(int lane, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
           float far_limit);
  [[nodiscard]] Eigen::Vector3f geometricNormal(int lane) const {
    return {rays.hit.Ng_x[lane], rays.hit.Ng_y[lane], rays.hit.Ng_z[lane]};
  }
};

/// Embree's trees over the static geometry. Rays start 2 cm away from their origin.
class StaticTracer {
 public:
  StaticTracer(RTCDevice device, StaticGeometry geometry);

  [[nodiscard]] const RenderMesh& mesh() const { return geometry_.mesh; }
  [[nodiscard]] RTCScene scene() const { return scene_.get(); }

  /// The closest hits; coherent says that the rays run alike.
  void intersect(RayPacket& packet, bool coherent) const;
  /// Marks occluded lanes by a negative far limit.
  void occlude(RayPacket& packet) const;
  /// The triangle hit, as an index into mesh().triangles, or kNoTriangle.
  [[nodiscard]] std::uint32_t triangleOf(const RayPacket& packet, int lane) const {
    const unsigned geometry = packet.rays.hit.geomID[lane];
    return geometry == RTC_INVALID_GEOMETRY_ID ? kNoTriangle
                                               : first_[geometry] + packet.rays.hit.primID[lane];
  }

 private:
  StaticGeometry geometry_;
  EmbreeScene scene_;
  std::array<std::uint32_t, 8> first_{};  ///< first triangle of each Embree geometry
};

/// Attaches triangles [begin, end) of a mesh, which must outlive the scene, under a ray mask.
unsigned attachTriangles(RTCDevice device, RTCScene scene, const RenderMesh& mesh,
                         std::uint32_t begin, std::uint32_t end, unsigned mask);

}  // namespace parkade::sim
