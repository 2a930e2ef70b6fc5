// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/baker.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/random.hpp"
#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {
namespace {

constexpr float kProbeSpacing = 1.25F;  // m

}  // namespace

void Baker::bakeProbes(BakedLight& out, const std::vector<Eigen::Vector3f>& lux) const {
  constexpr int kLevels = ProbeGrid::kLevels;
  constexpr int kRays = 64;
  ProbeGrid& probes = out.probes;
  layFloor(probes.plane, kProbeSpacing);
  const std::vector<Place> ground = floorPlaces(probes.plane);
  probes.faces.resize(ground.size() * kLevels);
  for (const Place& place : ground) {
    probes.floor_z.push_back(place.position.z());
  }
  std::vector<std::uint8_t> inside(probes.faces.size(), 0);
  parallelFor(threads_, ground.size(), [&](std::size_t cell) {
    const FlushDenormals flush;
    for (int level = 0; level < kLevels; ++level) {
      const std::size_t at = cell * kLevels + level;
      const Eigen::Vector3f p =
          ground[cell].position + ProbeGrid::kHeights[level] * Eigen::Vector3f::UnitZ();
      auto& faces = probes.faces[at];
      faces.fill(Eigen::Vector3f::Zero());
      int backs = 0;
      for (int packet = 0; packet < kRays / kPacket; ++packet) {
        RayPacket rays;
        rays.clear(kMaskAll);
        Eigen::Vector3f directions[kPacket];
        for (int k = 0; k < kPacket; ++k) {
          const int s = packet * kPacket + k;
          const float z = 1.0F - 2.0F * (s + 0.5F) / kRays;
          const float b = 2.0F * kPi * radicalInverse(s);
          const float r = std::sqrt(1.0F - z * z);
          directions[k] << r * std::cos(b), r * std::sin(b), z;
          rays.set(k, p, directions[k], kFar);
        }
        tracer_.intersect(rays, false);
        for (int k = 0; k < kPacket; ++k) {
          const std::uint32_t triangle = tracer_.triangleOf(rays, k);
          if (triangle == kNoTriangle) {
            continue;
          }
          const RenderTriangle& t = tracer_.mesh().triangles[triangle];
          GatherHit hit{triangle, static_cast<std::uint8_t>(rays.rays.hit.u[k] * 255.0F),
                        static_cast<std::uint8_t>(rays.rays.hit.v[k] * 255.0F)};
          if (scene_.materials[t.material].is_floor) {
            const Eigen::Vector3f q = p + rays.rays.ray.tfar[k] * directions[k];
            hit.target = kFloorHit | static_cast<std::uint32_t>(coarse_.index(q.x(), q.y()));
          } else if (rays.geometricNormal(k).dot(directions[k]) > 0.0F) {
            ++backs;
          }
          const Eigen::Vector3f radiance = bounced(hit, lux) / kPi;
          for (int f = 0; f < 6; ++f) {
            const float c = directions[k][f / 2] * (f % 2 == 0 ? 1.0F : -1.0F);
            faces[f] += std::max(c, 0.0F) * (4.0F * kPi / kRays) * radiance;
          }
        }
      }
      inside[at] = backs > kRays / 4 || !ground[cell].used ? 1 : 0;
      DirectPacket packet;
      packet.count = 6;
      for (int f = 0; f < 6; ++f) {
        packet.position[f] = p;
        packet.normal[f] = Eigen::Vector3f::Zero();
        packet.normal[f][f / 2] = f % 2 == 0 ? 1.0F : -1.0F;
        packet.random[f] = hash64(at, f);
      }
      direct_.gather(packet);
      for (int f = 0; f < 6; ++f) {
        faces[f] += packet.lux[f];
      }
    }
  });
  // Probes inside pillars, walls or cars take the mean of their free neighbours.
  const std::vector<std::array<Eigen::Vector3f, 6>> original = probes.faces;
  for (int y = 0; y < probes.plane.ny; ++y) {
    for (int x = 0; x < probes.plane.nx; ++x) {
      for (int level = 0; level < kLevels; ++level) {
        const auto at = [&](int cx, int cy) {
          return (static_cast<std::size_t>(cy) * probes.plane.nx + cx) * kLevels + level;
        };
        if (inside[at(x, y)] == 0) {
          continue;
        }
        float count = 0.0F;
        std::array<Eigen::Vector3f, 6> sum;
        sum.fill(Eigen::Vector3f::Zero());
        for (int cy = std::max(0, y - 2); cy <= std::min(probes.plane.ny - 1, y + 2); ++cy) {
          for (int cx = std::max(0, x - 2); cx <= std::min(probes.plane.nx - 1, x + 2); ++cx) {
            if (inside[at(cx, cy)] == 0) {
              count += 1.0F;
              for (int f = 0; f < 6; ++f) {
                sum[f] += original[at(cx, cy)][f];
              }
            }
          }
        }
        for (int f = 0; f < 6 && count > 0.0F; ++f) {
          probes.faces[at(x, y)][f] = sum[f] / count;
        }
      }
    }
  }
}

/// Light of vehicles' vertices from the probes around, dimmed where the vehicle hides its own
/// surroundings.
void Baker::lightVehicles(BakedLight& out) const {
  const RenderMesh& mesh = tracer_.mesh();
  std::vector<std::uint8_t> vehicle(vertex_count_, 0);
  for (const RenderTriangle& t : mesh.triangles) {
    if (kindOf(t) == Kind::kVehicle) {
      for (const std::uint32_t v : t.v) {
        vehicle[v] = 1;
      }
    }
  }
  constexpr std::size_t kChunk = 4096;
  parallelFor(threads_, (vertex_count_ + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min((chunk + 1) * kChunk, vertex_count_);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      if (vehicle[i] != 0) {
        const auto cube = out.probes.cubeAt(mesh.positions[i]);
        out.vertices[i].lux = ProbeGrid::evaluate(cube, mesh.normals[i]) * mesh.openness[i];
      }
    }
  });
}

}  // namespace parkade::sim
