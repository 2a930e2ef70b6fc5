// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Pictures from above: the bird's-eye truth and the overview of a garage.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/renderer.hpp"
#include "parkade/sim/render/tile_tracer.hpp"
#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {
namespace {

constexpr unsigned kWithoutCeiling = kMaskSolid | kMaskFloor | kMaskMoving | kMaskOwnCar;
constexpr float kAbove = 20.0F;  // m over the vehicle's ground: above every garage level's ceiling
constexpr float kProbeHeight =
    1.0F;  // m: where a place is tested for lying inside a pillar or wall

/// Pillars and walls are open at the top: rays from above fall into them. A place inside one sees
/// the back of its faces; this names it.
SemanticClass solidAround(const StaticTracer& tracer, const Shader& shader, const Moment& moment,
                          const Eigen::Vector3f& floor) {
  RayPacket rays;
  rays.clear(kMaskSolid);
  const Eigen::Vector3f p = floor + kProbeHeight * Eigen::Vector3f::UnitZ();
  const std::array<Eigen::Vector3f, 4> directions{
      Eigen::Vector3f(0.8F, 0.6F, 0.0F), Eigen::Vector3f(-0.6F, 0.8F, 0.0F),
      Eigen::Vector3f(-0.8F, -0.6F, 0.0F), Eigen::Vector3f(0.6F, -0.8F, 0.0F)};
  for (std::size_t k = 0; k < directions.size(); ++k) {
    rays.set(static_cast<int>(k), p, directions[k], 3.0F);
  }
  tracer.intersect(rays, false);
  SemanticClass found = SemanticClass::kUnknown;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const SurfaceHit hit = hitOf(tracer, rays, static_cast<int>(k));
    if (hit.triangle == kNoTriangle || hit.geometric_normal.dot(directions[k]) <= 0.0F) {
      return SemanticClass::kUnknown;
    }
    found = shader.materialOf(hit, moment).label;
  }
  if (found == SemanticClass::kZoneMarker) {
    found = SemanticClass::kPillar;
  }
  return found == SemanticClass::kPillar || found == SemanticClass::kWall ? found
                                                                          : SemanticClass::kUnknown;
}

}  // namespace

OrthoImages Renderer::renderOrtho(const SE3& T_world_vehicle, int size_px, double metres_per_px,
                                  double t) const {
  PARKADE_CHECK(size_px > 0 && metres_per_px > 0.0, "{} px, {} m/px", size_px, metres_per_px);
  const auto now = moment(t, std::nullopt);
  const double yaw = T_world_vehicle.rotation().yaw();
  const Eigen::Vector2f forward(static_cast<float>(std::cos(yaw)),
                                static_cast<float>(std::sin(yaw)));
  const Eigen::Vector2f left(-forward.y(), forward.x());
  const Eigen::Vector3f origin = T_world_vehicle.translation().cast<float>();
  const auto step = static_cast<float>(metres_per_px);
  const float middle = 0.5F * static_cast<float>(size_px - 1);
  const Eigen::Vector3f down = -Eigen::Vector3f::UnitZ();
  Radiance radiance;
  radiance.width = size_px;
  radiance.height = size_px;
  radiance.pixels.assign(static_cast<std::size_t>(size_px) * size_px, Eigen::Vector3f::Zero());
  OrthoImages out;
  out.labels = cv::Mat(size_px, size_px, CV_8UC1, cv::Scalar(0));
  parallelFor(options_.threads, static_cast<std::size_t>(size_px), [&](std::size_t row) {
    const FlushDenormals flush;
    std::uint8_t* labels = out.labels.ptr<std::uint8_t>(static_cast<int>(row));
    for (int begin = 0; begin < size_px; begin += kPacket) {
      RayPacket rays;
      rays.clear(kWithoutCeiling);
      Eigen::Vector3f eyes[kPacket];
      const int lanes = std::min(kPacket, size_px - begin);
      for (int k = 0; k < lanes; ++k) {
        const Eigen::Vector2f offset = (middle - static_cast<float>(row)) * step * forward +
                                       (middle - static_cast<float>(begin + k)) * step * left;
        eyes[k] << origin.x() + offset.x(), origin.y() + offset.y(), origin.z() + kAbove;
        rays.set(k, eyes[k], down, kFar);
      }
      traceBoth(tracer_, now->scene.get(), rays, true);
      std::array<SurfaceHit, kPacket> hits;
      std::array<SampleGroup, kPacket> groups;
      std::array<Surface, kPacket> surfaces;
      int count = 0;
      for (int k = 0; k < lanes; ++k) {
        SurfaceHit& hit = hits[static_cast<std::size_t>(k)];
        hit = hitOf(tracer_, rays, k);
        if (hit.triangle != kNoTriangle) {
          groups[static_cast<std::size_t>(count++)] = {&hit, &down, &eyes[k], step / hit.t};
        }
      }
      shader_.shade(groups.data(), count, 1, *now, surfaces.data());
      std::size_t next = 0;
      for (int k = 0; k < lanes; ++k) {
        const SurfaceHit& hit = hits[static_cast<std::size_t>(k)];
        if (hit.triangle == kNoTriangle) {
          continue;
        }
        const Surface& surface = surfaces[next++];
        const Eigen::Vector3f p = eyes[k] + hit.t * down;
        SemanticClass label = shader_.labelOf(hit, p, *now);
        if (surface.is_floor) {
          const SemanticClass solid = solidAround(tracer_, shader_, *now, p);
          label = solid == SemanticClass::kUnknown ? label : solid;
        }
        radiance.pixels[row * size_px + begin + k] = surface.radiance;
        labels[begin + k] = static_cast<std::uint8_t>(label);
      }
    }
  });
  SensorOptions quiet = options_.sensor;
  quiet.noise = false;
  quiet.vignetting = false;
  const SensorModel sensor(quiet);
  out.colour = sensor.expose(radiance, sensor.meter(radiance), {}, 0, options_.threads);
  return out;
}

cv::Mat Renderer::renderOverview(const Camera& camera, const SE3& T_world_cam, double t) const {
  const auto now = moment(t, std::nullopt);
  FrameSetup setup = setupFor(*now);
  setup.mask = kWithoutCeiling;
  setup.open_above = true;
  setup.reflections = false;
  const RayTable table(camera, 2, {0.0, 0.0});
  Radiance radiance;
  traceFrame(setup, table, T_world_cam, radiance);
  SensorOptions quiet = options_.sensor;
  quiet.noise = false;
  quiet.vignetting = false;
  const SensorModel sensor(quiet);
  return sensor.expose(radiance, sensor.meter(radiance), {}, 0, options_.threads);
}

}  // namespace parkade::sim
