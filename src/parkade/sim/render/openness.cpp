// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/openness.hpp"

#include <cmath>
#include <limits>

#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {
namespace {

constexpr int kOpennessRays = 32;
constexpr float kOpennessReach = 1.2F;  // m
constexpr float kLeast = 0.1F;          // light that finds its way by bounces

}  // namespace

std::vector<float> opennessOf(const RenderMesh& mesh, RTCScene scene) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector3f high = -low;
  for (const Eigen::Vector3f& p : mesh.positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  std::vector<float> out(mesh.positions.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Eigen::Vector3f n = mesh.normals[i];
    const Eigen::Vector3f p = mesh.positions[i] + 0.01F * n;
    int open = 0;
    for (int begin = 0; begin < kOpennessRays; begin += kPacket) {
      RayPacket rays;
      rays.clear(kMaskAll);
      bool below[kPacket];
      for (int k = 0; k < kPacket; ++k) {
        const int s = begin + k;
        const float z = 1.0F - 2.0F * (s + 0.5F) / kOpennessRays;
        const float b = 2.39996323F * s;  // golden angle
        const float r = std::sqrt(1.0F - z * z);
        // A point of the sphere plus the normal is distributed by the cosine to the normal.
        Eigen::Vector3f d = n + 0.999F * Eigen::Vector3f(r * std::cos(b), r * std::sin(b), z);
        d.normalize();
        rays.set(k, p, d, kOpennessReach);
        const Eigen::Vector3f ground = p + d * (d.z() < -1e-3F ? p.z() / -d.z() : 0.0F);
        below[k] = d.z() < -1e-3F && ground.x() > low.x() && ground.x() < high.x() &&
                   ground.y() > low.y() && ground.y() < high.y();
      }
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcOccluded16(rays.valid, scene, &context, &rays.rays.ray);
      for (int k = 0; k < kPacket; ++k) {
        open += !below[k] && rays.rays.ray.tfar[k] >= 0.0F ? 1 : 0;
      }
    }
    out[i] = kLeast + (1.0F - kLeast) * static_cast<float>(open) / kOpennessRays;
  }
  return out;
}

std::vector<float> opennessOf(const RenderMesh& mesh, RTCDevice device) {
  RenderMesh copy = mesh;
  copy.positions.reserve(copy.positions.size() + 1);
  const EmbreeScene scene(rtcNewScene(device));
  attachTriangles(device, scene.get(), copy, 0, static_cast<std::uint32_t>(copy.triangles.size()),
                  kMaskAll);
  rtcCommitScene(scene.get());
  return opennessOf(copy, scene.get());
}

}  // namespace parkade::sim
