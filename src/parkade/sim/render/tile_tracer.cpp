// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/tile_tracer.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {
namespace {

void traceMoving(RTCScene moving, RayPacket& packet, bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags =
      coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcIntersect16(packet.valid, moving, &context, &packet.rays);
}

}  // namespace

bool TileTracer::showsMoving(const RayTable::Cone& cone, int row, bool mirrored) const {
  constexpr float kLobe = 0.35F;  // rad: mirror rays spread around the ideal direction
  Eigen::Vector3f axis = places_.rotation(row) * cone.axis;
  Eigen::Vector3f eye = places_.eye(row);
  float angle = std::acos(std::clamp(cone.cosine, -1.0F, 1.0F)) + 0.01F;
  if (mirrored) {  // the eye below the floor, looking up
    axis.z() = -axis.z();
    eye.z() = 2.0F * floor_z_ - eye.z();
    angle += kLobe;
  }
  return setup_.moment->showsIn(eye, axis, angle);
}

RTCScene TileTracer::movingIn(int tile, bool mirrored) const {
  if (setup_.moment->scene == nullptr) {
    return nullptr;
  }
  const RayTable::Cone& cone = table_.cone(tile);
  const int top = tile / table_.tilesX() * RayTable::kTile;
  const bool shows =
      showsMoving(cone, top, mirrored) ||
      (places_.rolling() && (showsMoving(cone, top + RayTable::kTile - 1, mirrored) ||
                             showsMoving(cone, table_.height() / 2, mirrored)));  // the own car
  return shows ? setup_.moment->scene.get() : nullptr;
}

void TileTracer::trace(int tile, std::uint64_t asked, TileSamples& out) const {
  const RTCScene moving = movingIn(tile, false);
  const int top = tile / table_.tilesX() * RayTable::kTile;
  const int samples = table_.grid() * table_.grid();
  table_.prefetchSpread(tile);
  const RayTable::Packet* packets = table_.packets(tile);
  RayPacket rays;
  for (int p = 0; p < table_.packetsPerTile(); ++p) {
    if ((asked >> static_cast<unsigned>(p) & 1U) == 0U) continue;
    const RayTable::Packet& packet = packets[p];
    rays.clear(places_.rolling() ? setup_.mask & ~kMaskOwnCar : setup_.mask);
    for (int k = 0; k < kPacket; ++k) {
      rays.valid[k] = (packet.valid >> static_cast<unsigned>(k) & 1U) != 0U ? -1 : 0;
      const int row = top + table_.slot(p, k) / samples / RayTable::kTile;
      const Eigen::Matrix3f& R = places_.rotation(row);
      const Eigen::Vector3f& eye = places_.eye(row);
      rays.rays.ray.org_x[k] = eye.x();
      rays.rays.ray.org_y[k] = eye.y();
      rays.rays.ray.org_z[k] = eye.z();
      rays.rays.ray.dir_x[k] =
          R(0, 0) * packet.x[k] + R(0, 1) * packet.y[k] + R(0, 2) * packet.z[k];
      rays.rays.ray.dir_y[k] =
          R(1, 0) * packet.x[k] + R(1, 1) * packet.y[k] + R(1, 2) * packet.z[k];
      rays.rays.ray.dir_z[k] =
          R(2, 0) * packet.x[k] + R(2, 1) * packet.y[k] + R(2, 2) * packet.z[k];
      if (rays.valid[k] != 0) rays.rays.ray.tfar[k] = kFar;
      const auto i = static_cast<std::size_t>(table_.slot(p, k));
      out.directions[i] << rays.rays.ray.dir_x[k], rays.rays.ray.dir_y[k], rays.rays.ray.dir_z[k];
    }
    if (packet.valid != 0U) {
      traceBoth(*setup_.tracer, moving, rays, true);
      if (places_.rolling() && moving != nullptr) meetOwnCar(packet, moving, rays);
    }
    for (int k = 0; k < kPacket; ++k) {
      const auto i = static_cast<std::size_t>(table_.slot(p, k));
      readHit(*setup_.tracer, rays, k, out.hits[i]);
      setup_.shader->prefetch(out.hits[i]);
      if (rays.valid[k] == 0) {
        out.hits[i].t = -1.0F;  // no ray at all: black
      }
    }
  }
}

void TileTracer::meetOwnCar(const RayTable::Packet& packet, RTCScene moving,
                            RayPacket& rays) const {
  const Eigen::Matrix3f& R = places_.rotation();
  for (int k = 0; k < kPacket; ++k) {
    rays.rays.ray.org_x[k] = places_.eye().x();
    rays.rays.ray.org_y[k] = places_.eye().y();
    rays.rays.ray.org_z[k] = places_.eye().z();
    const Eigen::Vector3f direction = R * Eigen::Vector3f(packet.x[k], packet.y[k], packet.z[k]);
    rays.rays.ray.dir_x[k] = direction.x();
    rays.rays.ray.dir_y[k] = direction.y();
    rays.rays.ray.dir_z[k] = direction.z();
    rays.rays.ray.mask[k] = (setup_.mask & ~kMaskMoving) | kMaskOwnCar;
  }
  traceMoving(moving, rays, true);
}

void traceBoth(const StaticTracer& tracer, RTCScene moving, RayPacket& packet, bool coherent) {
  tracer.intersect(packet, coherent);
  if (moving != nullptr) traceMoving(moving, packet, coherent);
}

}  // namespace parkade::sim
