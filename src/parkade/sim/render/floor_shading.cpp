// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// The floor's look and light, sixteen groups of samples at once.
#include <algorithm>
#include <cstring>
#include <numbers>

#include "parkade/sim/render/floor_rays_kernel.hpp"
#include "parkade/sim/render/shading.hpp"

namespace parkade::sim {
namespace {

constexpr float kInvPi = std::numbers::inv_pi_v<float>;
constexpr int kGroups = FloorBlock::kGroups;
static_assert(FloorRays::kRays == kGroups && kLightLanes == kGroups &&
              FloorRays::kMaxTaps * kMaxSamples <= FloorBlock::kPoints);

/// The places where a group looks at the floor; returns the sum of its hits.
Eigen::Vector3f addPoints(const SampleGroup& group, const FloorRays& rays, int k, int& end,
                          FloorBlock& block) {
  const int taps = rays.taps[k];
  const float start = -0.5F * static_cast<float>(taps - 1);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int i = 0; i < group.count; ++i) {
    const Eigen::Vector3f p = *group.eye + group.hit(i).t * group.direction(i);
    sum += p;
    for (int tap = 0; tap < taps; ++tap) {
      const float along = start + static_cast<float>(tap);
      block.x[static_cast<std::size_t>(end)] = p.x() + along * rays.step_x[k];
      block.y[static_cast<std::size_t>(end)] = p.y() + along * rays.step_y[k];
      ++end;
    }
  }
  return sum;
}

}  // namespace

Eigen::Vector3f Shader::floorLux(const GridPlaces& places, int k, const Moment& moment) const {
  const BakedPoint* const upper = &light_.floor[static_cast<std::size_t>(places.cell[k])];
  const BakedPoint* const lower = upper + light_.floor_grid.nx;
  const std::array<const BakedPoint*, 4> points{upper, upper + 1, lower, lower + 1};
  Eigen::Vector4f lux = Eigen::Vector4f::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    float weight = places.weights[i][k];
    if (!moment.lamp_brightness.empty()) {
      weight *= flickerFactor(points[i]->flicker_lamp, points[i]->flicker_share, moment);
    }
    // The whole point in one go; its last four bytes, the flickering lamp, are left out at the end.
    static_assert(sizeof(BakedPoint) == sizeof(Eigen::Vector4f));
    Eigen::Vector4f point;
    std::memcpy(point.data(), points[i], sizeof(point));
    lux += weight * point;
  }
  return lux.head<3>();
}

void Shader::shadeFloor(const FloorGroups& floor, int samples, const Moment& moment) const {
  // 1. How far each group looks around on the floor.
  FloorRays rays;
  for (int k = 0; k < kGroups; ++k) {
    // Lanes without a group repeat the first.
    const SampleGroup& group = *floor.groups[static_cast<std::size_t>(k < floor.count ? k : 0)];
    const SurfaceHit& hit = group.hit(0);
    const Eigen::Vector3f& direction = group.direction(0);
    Eigen::Vector3f normal;
    if (hit.object < 0) {
      const ShadeTriangle& t = triangles_[hit.triangle];
      const float wa = 1.0F - hit.u - hit.v;
      const Eigen::Vector4f n = wa * t.normal(0) + hit.u * t.normal(1) + hit.v * t.normal(2);
      normal = n.head<3>();
    } else {
      Eigen::Vector3f unused;
      surfaceAt(hit, moment, normal, unused);
    }
    rays.normal_x[k] = normal.x();
    rays.normal_y[k] = normal.y();
    rays.normal_z[k] = normal.z();
    rays.direction_x[k] = direction.x();
    rays.direction_y[k] = direction.y();
    rays.direction_z[k] = direction.z();
    rays.distance[k] = hit.t;
    rays.spread[k] = group.spread;
  }
  spreadOverFloor(rays, samples > 1 ? 0.3F : 0.6F);

  // 2. What the floor looks like there.
  FloorBlock block;
  block.count = floor.count;
  LightPoints points;
  int end = 0;
  for (int k = 0; k < floor.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    block.first[at] = end;
    block.footprint[at] = rays.footprint[k];
    const SampleGroup& group = *floor.groups[at];
    Surface& out = *floor.out[at];
    out.position = addPoints(group, rays, k, end, block) / static_cast<float>(group.count);
    out.normal << rays.normal_x[k], rays.normal_y[k], rays.normal_z[k];
    points.x[k] = out.position.x();
    points.y[k] = out.position.y();
    points.z[k] = out.position.z();
  }
  block.first[static_cast<std::size_t>(floor.count)] = end;
  for (int k = floor.count; k < kGroups; ++k) {
    block.footprint[static_cast<std::size_t>(k)] = block.footprint[0];
    points.x[k] = points.x[0];
    points.y[k] = points.y[0];
    points.z[k] = points.z[0];
  }
  const FloorGrid& grid = light_.floor_grid;
  GridPlaces places;
  placeInGrid({grid.min.x(), grid.min.y(), grid.cell, grid.nx, grid.ny}, points.x, points.y,
              places);
  for (int k = 0; k < floor.count; ++k) {
    const BakedPoint* const upper = &light_.floor[static_cast<std::size_t>(places.cell[k])];
    __builtin_prefetch(upper);
    __builtin_prefetch(upper + grid.nx);
  }
  FloorLooks looks;
  scene_.floor->means(block, looks);

  // 3. Light.
  unsigned reach = 0;
  for (int k = 0; k < floor.count; ++k) {
    reach |= moment.reach_grid.at(points.x[k], points.y[k]);
  }
  alignas(64) std::array<float, kGroups> share;
  alignas(64) std::array<float, kGroups> beam;
  const bool shadowed = (reach & ReachGrid::kShadow) != 0U;
  const bool beamed = (reach & ReachGrid::kBeams) != 0U;
  if (shadowed) {
    moment.floorShares(points.x, points.y, share.data());
  }
  if (beamed) {
    std::copy_n(rays.normal_x, kGroups, points.normal_x);
    std::copy_n(rays.normal_y, kGroups, points.normal_y);
    std::copy_n(rays.normal_z, kGroups, points.normal_z);
    moment.beamLux(reach, points, beam.data());
  }
  for (int k = 0; k < floor.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    Surface& out = *floor.out[at];
    Eigen::Vector3f lux = floorLux(places, k, moment);
    if (shadowed) {
      lux *= share[at];
    }
    if (beamed) {
      lux += kBeamColour * beam[at];
    }
    const Eigen::Vector3f albedo(looks.red[at], looks.green[at], looks.blue[at]);
    out.radiance = albedo.cwiseProduct(lux) * kInvPi;
    out.specular = looks.specular[at];
    out.roughness = looks.roughness[at];
    out.is_floor = true;
  }
}

}  // namespace parkade::sim
