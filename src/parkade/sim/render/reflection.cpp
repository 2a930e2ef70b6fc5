// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/reflection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/tile_tracer.hpp"
#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {
namespace {

constexpr float kCoatBlur = 0.2F;    // roughness: a lone ray per pixel must not sparkle
constexpr float kSteepest = 0.3F;    // slope down to which a coat's image of lamps widens
constexpr float kFloorNear = 5e-4F;  // m: closer than other rays start, or walls leak
constexpr float kLampRoom = 0.4F;    // m: what hangs this far below the lamps hides none
// rad: mirror images of textures are a little soft, in floors, which mean over a lobe, more so.
constexpr float kMirrorSpread = 0.01F;
constexpr float kFloorMirrorSpread = 0.03F;

constexpr int raysOf(MirrorDensity density) {
  return density == MirrorDensity::kQuarter ? 4 : 2;
}

using Lobe = std::array<Eigen::Vector2f, kMirrorPlaces>;

/// Slopes (microfacet normal against the mean normal) for the places of the pattern: GGX with unit
/// width, stratified; the widest tail is left out.
Lobe makeLobe(MirrorDensity density) {
  Lobe pattern;
  const int rays = raysOf(density);
  for (int n = 0; n < rays; ++n) {
    const float u = 0.9F * (static_cast<float>(n) + 0.5F) / static_cast<float>(rays);
    const float angle = 2.39996323F * static_cast<float>(n);
    const float slope = std::sqrt(u / (1.0F - u));
    pattern[static_cast<std::size_t>(n)] << slope * std::cos(angle), slope * std::sin(angle);
  }
  return pattern;
}

const Eigen::Vector2f& lobeSlope(MirrorDensity density, int place) {
  static const std::array<Lobe, 2> kLobes{makeLobe(MirrorDensity::kQuarter),
                                          makeLobe(MirrorDensity::kEighth)};
  return kLobes[static_cast<std::size_t>(density)][static_cast<std::size_t>(place)];
}

/// Two 4-pixel means, one after the other, weigh neighbours by 1, 2, 3, 4, 3, 2, 1. Only even
/// places hold rays: from an even place those 2 away count, from an odd one those 1 and 3 away.
/// step: between neighbours in at, whose first counts for the place.
Eigen::Vector4f tentSum(const Eigen::Vector4f* at, std::ptrdiff_t step, bool odd) {
  if (odd) {
    return at[-step] + 3.0F * at[0] + 3.0F * at[step] + at[2 * step];
  }
  return 2.0F * at[-step] + 4.0F * at[0] + 2.0F * at[step];
}

}  // namespace

void ReflectionBuffer::reset(int w, int h) {
  width = w;
  height = h;
  stride = (w + 1) / 2 + 3;
  incoming.assign(static_cast<std::size_t>(stride) * ((h + 1) / 2), Eigen::Vector4f::Zero());
  weights.assign(static_cast<std::size_t>(w) * h, 0.0F);
}

void makeMirrorRay(const Surface& surface, const Eigen::Vector3f& direction, float weight,
                   MirrorDensity density, int place, MirrorRay& ray) {
  ray.place = static_cast<std::uint8_t>(place);
  ray.weight = weight;
  ray.from_floor = surface.is_floor;
  Eigen::Vector3f n = surface.normal;
  if (surface.is_floor) {
    const float cosine = -direction.dot(n);
    ray.lobe_direction = direction + 2.0F * cosine * n;
    ray.lobe_cosine = cosine;
    ray.lobe_roughness = surface.roughness;
    const float alpha = surface.roughness * surface.roughness;
    const Eigen::Vector2f& slope = lobeSlope(density, place);
    n.x() += alpha * slope.x();
    n.y() += alpha * slope.y();
    n.normalize();
  }
  ray.direction = direction - 2.0F * direction.dot(n) * n;
  const float rise = ray.direction.dot(surface.normal);
  if (rise < 0.01F) {  // a microfacet that would mirror into the floor
    ray.direction += (0.01F - rise) * surface.normal;
    ray.direction.normalize();
  }
  if (!surface.is_floor) {
    ray.lobe_direction = ray.direction;
    ray.lobe_cosine = std::max(ray.direction.z(), kSteepest);
    ray.lobe_roughness = std::max(surface.roughness, kCoatBlur);
  }
  ray.origin = surface.position + 0.002F * surface.normal;
}

namespace {

/// Traces rays and calls use(ray, radiance) for each. Lamps are too small for a few rays: their
/// image comes from their map, where a ray gets as far as they are high.
template <class Use>
void traceRays(const FrameSetup& setup, RTCScene moving, float near_limit, float spread,
               const MirrorRay* rays, int count, const Use& use) {
  // In two passes, for what a hit's shading reads takes long to come from memory.
  thread_local std::vector<SurfaceHit> hits;
  hits.resize(static_cast<std::size_t>(count));
  RayPacket packet;
  for (int begin = 0; begin < count; begin += kPacket) {
    const int lanes = std::min(kPacket, count - begin);
    packet.clear(kMaskAll & ~kMaskLamp);
    for (int k = 0; k < lanes; ++k) {
      packet.set(k, rays[begin + k].origin, rays[begin + k].direction, kFar);
      packet.rays.ray.tnear[k] = near_limit;
    }
    traceBoth(*setup.tracer, moving, packet, true);
    for (int k = 0; k < lanes; ++k) {
      SurfaceHit& hit = hits[static_cast<std::size_t>(begin + k)];
      readHit(*setup.tracer, packet, k, hit);
      setup.shader->prefetch(hit);
    }
  }
  const float lamps_height = setup.shader->lamps().height() - kLampRoom;
  thread_local std::vector<SampleGroup> groups;
  thread_local std::vector<Surface> surfaces;
  groups.clear();
  for (int k = 0; k < count; ++k) {
    const SurfaceHit& hit = hits[static_cast<std::size_t>(k)];
    if (hit.triangle != kNoTriangle) {
      groups.push_back({&hit, &rays[k].direction, &rays[k].origin, spread});
    }
  }
  surfaces.resize(groups.size());
  setup.shader->shade(groups.data(), static_cast<int>(groups.size()), 1, *setup.moment,
                      surfaces.data());
  std::size_t next = 0;
  for (int k = 0; k < count; ++k) {
    const MirrorRay& ray = rays[k];
    const SurfaceHit& hit = hits[static_cast<std::size_t>(k)];
    if (hit.triangle == kNoTriangle) {
      use(ray, setup.shader->missed(ray.origin, ray.direction));
      continue;
    }
    Surface& surface = surfaces[next++];
    if (hit.t * ray.direction.z() > lamps_height - ray.origin.z()) {
      surface.radiance += setup.shader->lamps().glow(ray.origin, ray.lobe_direction,
                                                     ray.lobe_cosine, ray.lobe_roughness);
    }
    use(ray, surface.radiance);
  }
}

}  // namespace

void traceFloorMirror(const FrameSetup& setup, RTCScene moving, const MirrorRay* rays, int count,
                      ReflectionBuffer& floor) {
  traceRays(setup, moving, kFloorNear, kFloorMirrorSpread, rays, count,
            [&](const MirrorRay& ray, const Eigen::Vector3f& radiance) {
              floor.incoming[ray.pixel] << radiance.x(), radiance.y(), radiance.z(), 1.0F;
            });
}

void traceMirror(const FrameSetup& setup, const MirrorRay* rays, int count, Radiance& out) {
  traceRays(setup, setup.moment->scene.get(), kNear, kMirrorSpread, rays, count,
            [&](const MirrorRay& ray, const Eigen::Vector3f& radiance) {
              out.pixels[ray.pixel] += ray.weight * radiance;
            });
}

void addFloorReflections(ReflectionBuffer& floor, int threads, Radiance& out) {
  const int width = floor.width;
  const int height = floor.height;
  const int rows = (height + 1) / 2;
  // A row of zeros above, two below.
  std::vector<Eigen::Vector4f>& across = floor.across;
  across.resize(static_cast<std::size_t>(rows + 3) * width);
  std::fill_n(across.begin(), width, Eigen::Vector4f::Zero());
  std::fill_n(across.end() - 2 * width, 2 * width, Eigen::Vector4f::Zero());
  parallelFor(threads, static_cast<std::size_t>(rows), [&](std::size_t row) {
    const Eigen::Vector4f* from = floor.incoming.data() + row * floor.stride + 1;
    Eigen::Vector4f* to = across.data() + (row + 1) * width;
    for (int x = 0; x < width; ++x) {
      to[x] = tentSum(from + x / 2, 1, x % 2 != 0);
    }
  });
  parallelFor(threads, static_cast<std::size_t>(height), [&](std::size_t y) {
    const Eigen::Vector4f* from = across.data() + (y / 2 + 1) * width;
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = y * width + x;
      if (floor.weights[pixel] <= 0.0F) {
        continue;
      }
      const Eigen::Vector4f sum = tentSum(from + x, width, y % 2 != 0);
      if (sum.w() > 0.0F) {
        out.pixels[pixel] += floor.weights[pixel] / sum.w() * sum.head<3>();
      }
    }
  });
}

}  // namespace parkade::sim
