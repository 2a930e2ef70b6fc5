// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "parkade/geometry/se3.hpp"
#include "parkade/sim/render/frame.hpp"

namespace parkade::sim {

inline constexpr int kTilePixels = RayTable::kTile * RayTable::kTile;

/// The samples of a tile: [pixel * samples + sample].
struct TileSamples {
  std::array<SurfaceHit, kTilePixels * kMaxSamples> hits;
  std::array<Eigen::Vector3f, kTilePixels * kMaxSamples> directions;
};

/// Sends the rays of a camera at its place, tile by tile.
class TileTracer {
 public:
  TileTracer(const FrameSetup& setup, const RayTable& table, const SE3& T_world_cam)
      : setup_(setup),
        table_(table),
        R_(T_world_cam.rotation().matrix().cast<float>()),
        eye_(T_world_cam.translation().cast<float>()),
        floor_z_(setup.shader->floorHeight(eye_)) {}

  void trace(int tile, TileSamples& out) const { trace(tile, ~std::uint64_t{0}, out); }
  /// Only the packets that are asked for, a bit each.
  void trace(int tile, std::uint64_t packets, TileSamples& out) const;
  /// What moves, if any of it may show in a tile, or in the floor's mirror image there.
  [[nodiscard]] RTCScene movingIn(int tile, bool mirrored) const;
  [[nodiscard]] const Eigen::Vector3f& eye() const { return eye_; }

 private:
  const FrameSetup& setup_;
  const RayTable& table_;
  const Eigen::Matrix3f R_;
  const Eigen::Vector3f eye_;
  const float floor_z_;  ///< below the eye
};

/// Traces a packet through the static scene and then through what moves (where not null).
void traceBoth(const StaticTracer& tracer, RTCScene moving, RayPacket& packet, bool coherent);

/// A lane's result after traceBoth. Fills in place: a copy would wait for the stores before it.
inline void readHit(const StaticTracer& tracer, const RayPacket& packet, int lane,
                    SurfaceHit& hit) {
  const auto& raw = packet.rays.hit;
  if (raw.geomID[lane] == RTC_INVALID_GEOMETRY_ID || packet.valid[lane] == 0) {
    hit.triangle = kNoTriangle;
    hit.object = -1;
    hit.t = 0.0F;
    return;
  }
  const bool moving = raw.instID[0][lane] != RTC_INVALID_GEOMETRY_ID;
  hit.object = moving ? static_cast<std::int32_t>(raw.instID[0][lane]) : -1;
  hit.triangle = moving ? raw.primID[lane] : tracer.triangleOf(packet, lane);
  hit.u = raw.u[lane];
  hit.v = raw.v[lane];
  hit.t = packet.rays.ray.tfar[lane];
  hit.geometric_normal = packet.geometricNormal(lane);
}
inline SurfaceHit hitOf(const StaticTracer& tracer, const RayPacket& packet, int lane) {
  SurfaceHit hit;
  readHit(tracer, packet, lane, hit);
  return hit;
}

}  // namespace parkade::sim
