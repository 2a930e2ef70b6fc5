// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "parkade/sim/render/camera_places.hpp"
#include "parkade/sim/render/frame.hpp"

namespace parkade::sim {

inline constexpr int kTilePixels = RayTable::kTile * RayTable::kTile;

/// The samples of a tile: [pixel * samples + sample].
struct TileSamples {
  std::array<SurfaceHit, kTilePixels * kMaxSamples> hits;
  std::array<Eigen::Vector3f, kTilePixels * kMaxSamples> directions;
};

/// Sends the rays of a camera at its places, tile by tile. The own car, which goes along, is met as
/// from the middle row's (and lit as if it lay on the row's own ray, some centimetres off); what
/// else moves stands as at that row's time.
class TileTracer {
 public:
  /// The places must outlive it.
  TileTracer(const FrameSetup& setup, const RayTable& table, const CameraPlaces& places)
      : setup_(setup),
        table_(table),
        places_(places),
        floor_z_(setup.shader->floorHeight(places.eye())) {}
  TileTracer(const FrameSetup& setup, const RayTable& table, CameraPlaces&& places) = delete;

  void trace(int tile, TileSamples& out) const { trace(tile, ~std::uint64_t{0}, out); }
  /// Only the packets that are asked for, a bit each.
  void trace(int tile, std::uint64_t packets, TileSamples& out) const;
  /// What moves, if any of it may show in a tile, or in the floor's mirror image there.
  [[nodiscard]] RTCScene movingIn(int tile, bool mirrored) const;
  [[nodiscard]] const Eigen::Vector3f& eye(int row) const { return places_.eye(row); }

 private:
  [[nodiscard]] bool showsMoving(const RayTable::Cone& cone, int row, bool mirrored) const;
  /// Whether a ray meets the own car before what it met so far.
  void meetOwnCar(const RayTable::Packet& packet, RTCScene moving, RayPacket& rays) const;

  const FrameSetup& setup_;
  const RayTable& table_;
  const CameraPlaces& places_;
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
