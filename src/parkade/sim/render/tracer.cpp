// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/tracer.hpp"

#include <algorithm>
#include <limits>

#include "parkade/core/check.hpp"

namespace parkade::sim {
void RayPacket::clear(unsigned mask) {
  std::fill_n(valid, kPacket, 0);
  // Where the processor has no instructions for sixteen lanes, Embree looks at the limits, and not
  // at valid alone: lanes that are off must hold rays that are well formed and end before they
  // begin.
  std::fill_n(rays.ray.org_x, kPacket, 0.0F);
  std::fill_n(rays.ray.org_y, kPacket, 0.0F);
  std::fill_n(rays.ray.org_z, kPacket, 0.0F);
  std::fill_n(rays.ray.dir_x, kPacket, 0.0F);
  std::fill_n(rays.ray.dir_y, kPacket, 0.0F);
  std::fill_n(rays.ray.dir_z, kPacket, 1.0F);
  std::fill_n(rays.ray.tfar, kPacket, -std::numeric_limits<float>::infinity());
  std::fill_n(rays.ray.tnear, kPacket, kNear);
  std::fill_n(rays.ray.time, kPacket, 0.0F);
  std::fill_n(rays.ray.mask, kPacket, mask);
  std::fill_n(rays.ray.id, kPacket, 0U);
  std::fill_n(rays.ray.flags, kPacket, 0U);
  std::fill_n(rays.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(rays.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
}

void RayPacket::set(int lane, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                    float far_limit) {
  valid[lane] = -1;
  rays.ray.org_x[lane] = origin.x();
  rays.ray.org_y[lane] = origin.y();
  rays.ray.org_z[lane] = origin.z();
  rays.ray.dir_x[lane] = direction.x();
  rays.ray.dir_y[lane] = direction.y();
  rays.ray.dir_z[lane] = direction.z();
  rays.ray.tfar[lane] = far_limit;
}

unsigned attachTriangles(RTCDevice device, RTCScene scene, const RenderMesh& mesh,
                         std::uint32_t begin, std::uint32_t end, unsigned mask) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Embree reads 16 bytes of the last vertex: the vector must have room for one float more.
  PARKADE_CHECK(mesh.positions.capacity() > mesh.positions.size(), "no padding after {} vertices",
                mesh.positions.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             mesh.positions.data(), 0, sizeof(Eigen::Vector3f),
                             mesh.positions.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), begin * sizeof(RenderTriangle),
                             sizeof(RenderTriangle), end - begin);
  rtcSetGeometryMask(geometry, mask);
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return id;
}

StaticTracer::StaticTracer(RTCDevice device, StaticGeometry geometry)
    : geometry_(std::move(geometry)), scene_(rtcNewScene(device)) {
  geometry_.mesh.positions.reserve(geometry_.mesh.positions.size() + 1);
  // High quality splits triangles in space, which an assertion of Embree 3.13 ends in one of some
  // 500 garages, and traces these scenes no faster.
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
  for (const StaticGeometry::Group& group : geometry_.groups) {
    const unsigned id =
        attachTriangles(device, scene_.get(), geometry_.mesh, group.begin, group.end, group.mask);
    first_.at(id) = group.begin;
  }
  rtcCommitScene(scene_.get());
  PARKADE_CHECK(rtcGetDeviceError(device) == RTC_ERROR_NONE, "Embree could not build the scene");
}

void StaticTracer::intersect(RayPacket& packet, bool coherent) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags =
      coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcIntersect16(packet.valid, scene_.get(), &context, &packet.rays);
}

void StaticTracer::occlude(RayPacket& packet) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(packet.valid, scene_.get(), &context, &packet.rays.ray);
}

}  // namespace parkade::sim
