// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/tile_tracer.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {
RTCScene TileTracer::movingIn(int tile, bool mirrored) const {
  if (setup_.moment->scene == nullptr) {
    return nullptr;
  }
  constexpr float kLobe = 0.35F;  // rad: mirror rays spread around the ideal direction
  const RayTable::Cone& cone = table_.cone(tile);
  Eigen::Vector3f axis = R_ * cone.axis;
  Eigen::Vector3f eye = eye_;
  float angle = std::acos(std::clamp(cone.cosine, -1.0F, 1.0F)) + 0.01F;
  if (mirrored) {  // the eye below the floor, looking up
    axis.z() = -axis.z();
    eye.z() = 2.0F * floor_z_ - eye.z();
    angle += kLobe;
  }
  return setup_.moment->showsIn(eye, axis, angle) ? setup_.moment->scene.get() : nullptr;
}

void TileTracer::trace(int tile, std::uint64_t asked, TileSamples& out) const {
  const RTCScene moving = movingIn(tile, false);
  table_.prefetchSpread(tile);
  const RayTable::Packet* packets = table_.packets(tile);
  RayPacket rays;
  for (int p = 0; p < table_.packetsPerTile(); ++p) {
    if ((asked >> static_cast<unsigned>(p) & 1U) == 0U) continue;
    const RayTable::Packet& packet = packets[p];
    rays.clear(setup_.mask);
    for (int k = 0; k < kPacket; ++k) {
      rays.valid[k] = (packet.valid >> static_cast<unsigned>(k) & 1U) != 0U ? -1 : 0;
      rays.rays.ray.org_x[k] = eye_.x();
      rays.rays.ray.org_y[k] = eye_.y();
      rays.rays.ray.org_z[k] = eye_.z();
      rays.rays.ray.dir_x[k] =
          R_(0, 0) * packet.x[k] + R_(0, 1) * packet.y[k] + R_(0, 2) * packet.z[k];
      rays.rays.ray.dir_y[k] =
          R_(1, 0) * packet.x[k] + R_(1, 1) * packet.y[k] + R_(1, 2) * packet.z[k];
      rays.rays.ray.dir_z[k] =
          R_(2, 0) * packet.x[k] + R_(2, 1) * packet.y[k] + R_(2, 2) * packet.z[k];
      if (rays.valid[k] != 0) rays.rays.ray.tfar[k] = kFar;
    }
    if (packet.valid != 0U) {
      traceBoth(*setup_.tracer, moving, rays, true);
    }
    for (int k = 0; k < kPacket; ++k) {
      const auto i = static_cast<std::size_t>(table_.slot(p, k));
      readHit(*setup_.tracer, rays, k, out.hits[i]);
      setup_.shader->prefetch(out.hits[i]);
      if (rays.valid[k] == 0) {
        out.hits[i].t = -1.0F;  // no ray at all: black
      }
      out.directions[i] << rays.rays.ray.dir_x[k], rays.rays.ray.dir_y[k], rays.rays.ray.dir_z[k];
    }
  }
}

void traceBoth(const StaticTracer& tracer, RTCScene moving, RayPacket& packet, bool coherent) {
  tracer.intersect(packet, coherent);
  if (moving != nullptr) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect16(packet.valid, moving, &context, &packet.rays);
  }
}

}  // namespace parkade::sim
