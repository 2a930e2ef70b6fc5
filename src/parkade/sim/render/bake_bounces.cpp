// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/baker.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "parkade/core/random.hpp"
#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {
namespace {

constexpr int kSmoothingPasses = 2;

float fraction(float x) {
  return x - std::floor(x);
}
}  // namespace

float radicalInverse(std::uint32_t i) {
  i = (i << 16U) | (i >> 16U);
  i = ((i & 0x55555555U) << 1U) | ((i & 0xAAAAAAAAU) >> 1U);
  i = ((i & 0x33333333U) << 2U) | ((i & 0xCCCCCCCCU) >> 2U);
  i = ((i & 0x0F0F0F0FU) << 4U) | ((i & 0xF0F0F0F0U) >> 4U);
  i = ((i & 0x00FF00FFU) << 8U) | ((i & 0xFF00FF00U) >> 8U);
  return static_cast<float>(i) * 2.3283064e-10F;
}

void Baker::gatherHits(const std::vector<Place>& places) {
  const int packets = (options_.gather_rays + kPacket - 1) / kPacket;
  const int rays_per_place = packets * kPacket;
  hits_.assign(places.size() * rays_per_place, GatherHit{});
  constexpr std::size_t kChunk = 64;
  parallelFor(threads_, (places.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const FlushDenormals flush;
    for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, places.size()); ++i) {
      if (!places[i].used) {
        continue;
      }
      const Eigen::Vector3f n = places[i].normal;
      const Eigen::Vector3f helper =
          std::abs(n.z()) < 0.9F ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitX();
      const Eigen::Vector3f x = n.cross(helper).normalized();
      const Eigen::Vector3f y = n.cross(x);
      const float shift_a = uniformOf(hash64(i, 1));
      const float shift_b = uniformOf(hash64(i, 2));
      for (int p = 0; p < packets; ++p) {
        RayPacket rays;
        rays.clear(kMaskAll);
        for (int k = 0; k < kPacket; ++k) {
          const int s = p * kPacket + k;
          const float a = fraction((s + 0.5F) / rays_per_place + shift_a);
          const float b = 2.0F * kPi * fraction(radicalInverse(s) + shift_b);
          const float r = std::sqrt(a);
          const Eigen::Vector3f d =
              r * std::cos(b) * x + r * std::sin(b) * y + std::sqrt(std::max(0.0F, 1.0F - a)) * n;
          rays.set(k, places[i].position, d, kFar);
        }
        tracer_.intersect(rays, false);
        for (int k = 0; k < kPacket; ++k) {
          const std::uint32_t triangle = tracer_.triangleOf(rays, k);
          if (triangle == kNoTriangle) {
            continue;
          }
          GatherHit& hit = hits_[i * rays_per_place + p * kPacket + k];
          if (scene_.materials[tracer_.mesh().triangles[triangle].material].is_floor) {
            const float t = rays.rays.ray.tfar[k];
            hit.target = kFloorHit | static_cast<std::uint32_t>(coarse_.index(
                                         rays.rays.ray.org_x[k] + t * rays.rays.ray.dir_x[k],
                                         rays.rays.ray.org_y[k] + t * rays.rays.ray.dir_y[k]));
          } else {
            hit.target = triangle;
            hit.u = static_cast<std::uint8_t>(rays.rays.hit.u[k] * 255.0F);
            hit.v = static_cast<std::uint8_t>(rays.rays.hit.v[k] * 255.0F);
          }
        }
      }
    }
  });
}

/// Albedo times illuminance where a gather ray ended: pi times the radiance it brings.
Eigen::Vector3f Baker::bounced(const GatherHit& hit,
                               const std::vector<Eigen::Vector3f>& lux) const {
  if (hit.target == kNoTriangle) {
    return Eigen::Vector3f::Zero();
  }
  if ((hit.target & kFloorHit) != 0U) {
    const std::uint32_t cell = hit.target & ~kFloorHit;
    return coarse_albedo_[cell].cwiseProduct(lux[vertex_count_ + cell]);
  }
  const RenderTriangle& t = tracer_.mesh().triangles[hit.target];
  if (kindOf(t) == Kind::kVehicle) {
    constexpr float kVehicleShare = 0.6F;  // of the floor's usual light, all sides alike
    return kVehicleShare * albedo_of_material_[t.material].cwiseProduct(usual_lux_);
  }
  const float u = static_cast<float>(hit.u) / 255.0F;
  const float v = static_cast<float>(hit.v) / 255.0F;
  const Eigen::Vector3f e = (1.0F - u - v) * lux[t.v[0]] + u * lux[t.v[1]] + v * lux[t.v[2]];
  return albedo_of_material_[t.material].cwiseProduct(e);
}

std::vector<Eigen::Vector3f> Baker::bounce(const std::vector<Eigen::Vector3f>& lux) const {
  std::vector<Eigen::Vector3f> out(lux.size());
  const std::size_t rays = hits_.size() / lux.size();
  constexpr std::size_t kChunk = 1024;
  parallelFor(threads_, (lux.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, lux.size()); ++i) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::size_t k = 0; k < rays; ++k) {
        sum += bounced(hits_[i * rays + k], lux);
      }
      out[i] = sum / static_cast<float>(rays);  // cosine-weighted directions: the plain mean
    }
  });
  return out;
}

/// Removes the gather's noise: means over mesh neighbours and over neighbouring floor cells.
void Baker::smooth(std::vector<Eigen::Vector3f>& lux) const {
  for (int pass = 0; pass < kSmoothingPasses; ++pass) {
    std::vector<Eigen::Vector3f> sum(lux);
    std::vector<float> weight(lux.size(), 1.0F);
    for (const RenderTriangle& t : tracer_.mesh().triangles) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = t.v[k];
        const std::uint32_t b = t.v[(k + 1) % 3];
        sum[a] += 0.5F * lux[b];
        sum[b] += 0.5F * lux[a];
        weight[a] += 0.5F;
        weight[b] += 0.5F;
      }
    }
    for (int y = 0; y < coarse_.ny; ++y) {
      for (int x = 0; x < coarse_.nx; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * coarse_.nx + x;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const int nx = x + dx;
            const int ny = y + dy;
            if ((dx == 0 && dy == 0) || nx < 0 || ny < 0 || nx >= coarse_.nx || ny >= coarse_.ny) {
              continue;
            }
            const std::size_t j = static_cast<std::size_t>(ny) * coarse_.nx + nx;
            if (coarse_places_[j].used) {
              sum[vertex_count_ + i] += 0.5F * lux[vertex_count_ + j];
              weight[vertex_count_ + i] += 0.5F;
            }
          }
        }
      }
    }
    for (std::size_t i = 0; i < lux.size(); ++i) {
      lux[i] = sum[i] / weight[i];
    }
  }
}

}  // namespace parkade::sim
