// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/direct_light.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/core/random.hpp"
#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {
namespace {

constexpr float kReach = 16.0F;        // m: a lamp 2.6 m up brings 3 % of its floor light beyond
constexpr float kLampCell = 4.0F;      // m
constexpr float kUpwardShare = 0.12F;  // of the flux
// The pool of light on the ceiling is narrower than the ceiling's cuts: it is lit from lower down.
constexpr float kUpwardDrop = 0.6F;  // m
constexpr float kLampGap = 0.15F;    // m: what is this close to a lamp casts no shadow (housing)
constexpr float kSkin = 0.01F;       // m: shadow rays start this far off the surface

int samplesAt(float distance) {
  return distance < 4.0F ? 4 : distance < 8.0F ? 2 : 1;
}

}  // namespace

DirectLight::DirectLight(const Scene& scene, const StaticTracer& tracer)
    : scene_(scene), tracer_(tracer) {
  if (scene.luminaires.empty()) {
    return;
  }
  Eigen::Vector2f low = Eigen::Vector2f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector2f high = -low;
  for (const Luminaire& lamp : scene.luminaires) {
    const Eigen::Vector2f center = 0.5F * (lamp.end_a + lamp.end_b).head<2>();
    low = low.cwiseMin(center);
    high = high.cwiseMax(center);
  }
  grid_min_ = low.array() - kReach;
  grid_nx_ = static_cast<int>((high.x() + kReach - grid_min_.x()) / kLampCell) + 1;
  grid_ny_ = static_cast<int>((high.y() + kReach - grid_min_.y()) / kLampCell) + 1;
  lamps_of_cell_.resize(static_cast<std::size_t>(grid_nx_) * grid_ny_);
  for (std::uint32_t i = 0; i < scene.luminaires.size(); ++i) {
    const Luminaire& lamp = scene.luminaires[i];
    if (lamp.flux_lm <= 0.0F) {
      continue;
    }
    const Eigen::Vector2f center = 0.5F * (lamp.end_a + lamp.end_b).head<2>();
    for (int y = 0; y < grid_ny_; ++y) {
      for (int x = 0; x < grid_nx_; ++x) {
        const Eigen::Vector2f cell = grid_min_ + kLampCell * Eigen::Vector2f(x + 0.5F, y + 0.5F);
        if ((cell - center).norm() < kReach) {
          lamps_of_cell_[static_cast<std::size_t>(y) * grid_nx_ + x].push_back(i);
        }
      }
    }
  }
}

const std::vector<std::uint32_t>* DirectLight::lampsNear(const Eigen::Vector3f& p) const {
  const int x = static_cast<int>(std::floor((p.x() - grid_min_.x()) / kLampCell));
  const int y = static_cast<int>(std::floor((p.y() - grid_min_.y()) / kLampCell));
  if (x < 0 || y < 0 || x >= grid_nx_ || y >= grid_ny_) {
    return nullptr;
  }
  return &lamps_of_cell_[static_cast<std::size_t>(y) * grid_nx_ + x];
}

void DirectLight::addLamp(std::uint32_t index, DirectPacket& packet) const {
  const Luminaire& lamp = scene_.luminaires[index];
  const Eigen::Vector3f along = lamp.end_b - lamp.end_a;
  const Eigen::Vector3f center = lamp.end_a + 0.5F * along;
  const int samples =
      along.squaredNorm() < 1e-4F ? 1 : samplesAt((center - packet.position[0]).norm());
  float lamp_lux[kPacket] = {};
  for (int s = 0; s < samples; ++s) {
    RayPacket rays;
    rays.clear(kMaskSolid | kMaskOverhead | kMaskFloor);
    float lux[kPacket];
    bool any = false;
    for (int k = 0; k < packet.count; ++k) {
      const float jitter = uniformOf(hash64(packet.random[k], index * 8ULL + s));
      const Eigen::Vector3f p = packet.position[k] + kSkin * packet.normal[k];
      Eigen::Vector3f to_lamp = lamp.end_a + along * ((s + jitter) / samples) - p;
      if (to_lamp.z() < 0.0F) {
        to_lamp.z() -= kUpwardDrop;
      }
      const float d2 = to_lamp.squaredNorm();
      const float d = std::sqrt(d2);
      const float cos_surface = to_lamp.dot(packet.normal[k]) / d;
      const float cos_lamp = to_lamp.z() / d;  // above 0: the point lies below the lamp
      if (cos_surface <= 0.0F || d < 1e-3F) {
        continue;
      }
      const float share = cos_lamp > 0.0F ? 1.0F - kUpwardShare : kUpwardShare;
      const float intensity = lamp.flux_lm * share / kPi * std::abs(cos_lamp) / samples;
      lux[k] = intensity * cos_surface / std::max(d2, 0.01F);
      rays.set(k, p, to_lamp / d, std::max(d - kLampGap, 0.03F));
      any = true;
    }
    if (!any) {
      continue;
    }
    tracer_.occlude(rays);
    for (int k = 0; k < packet.count; ++k) {
      if (rays.valid[k] != 0 && rays.rays.ray.tfar[k] >= 0.0F) {
        lamp_lux[k] += lux[k];
      }
    }
  }
  for (int k = 0; k < packet.count; ++k) {
    packet.lux[k] += lamp_lux[k] * lamp.colour;
    const float visible = lamp_lux[k] * luminance(lamp.colour);
    if (lamp.flicker_depth > 0.0F && visible > packet.flicker_lux[k]) {
      packet.flicker_lux[k] = visible;
      packet.flicker_lamp[k] = static_cast<std::uint16_t>(index);
    }
  }
}

void DirectLight::addDaylight(DirectPacket& packet) const {
  constexpr int kAcross = 4;
  constexpr int kUp = 3;
  const Scene::Daylight& day = scene_.daylight;
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  const Eigen::Vector3f across = up.cross(day.normal).normalized();
  const float sky = day.luminous_exitance / kPi;  // cd/m^2
  const float area = day.width * day.height / (kAcross * kUp);
  for (int s = 0; s < kAcross * kUp; ++s) {
    RayPacket rays;
    rays.clear(kMaskSolid | kMaskOverhead | kMaskFloor);
    float lux[kPacket];
    for (int k = 0; k < packet.count; ++k) {
      const std::uint64_t bits = hash64(packet.random[k], 0xda7ULL * 64 + s);
      const float a = (s % kAcross + uniformOf(bits)) / kAcross - 0.5F;
      const float b = (s / kAcross + uniformOf(hash64(bits))) / kUp - 0.5F;
      const Eigen::Vector3f p = packet.position[k] + kSkin * packet.normal[k];
      const Eigen::Vector3f ray = day.center + across * (a * day.width) + up * (b * day.height) - p;
      const float d2 = ray.squaredNorm();
      const float d = std::sqrt(d2);
      const float cosines = ray.dot(packet.normal[k]) * -ray.dot(day.normal) / d2;
      if (ray.dot(packet.normal[k]) <= 0.0F || cosines <= 0.0F) {
        continue;
      }
      lux[k] = sky * cosines * area / std::max(d2, area);
      rays.set(k, p, ray / d, std::max(d - kLampGap, 0.03F));
    }
    tracer_.occlude(rays);
    for (int k = 0; k < packet.count; ++k) {
      if (rays.valid[k] != 0 && rays.rays.ray.tfar[k] >= 0.0F) {
        packet.lux[k] += Eigen::Vector3f(0.95F, 1.0F, 1.08F) * lux[k];
      }
    }
  }
}

std::uint64_t DirectLight::cellOf(const Eigen::Vector3f& p) {
  const auto x = static_cast<std::int32_t>(std::floor(p.x() / kLampCell));
  const auto y = static_cast<std::int32_t>(std::floor(p.y() / kLampCell));
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32U |
         static_cast<std::uint32_t>(x);
}

void DirectLight::gather(DirectPacket& packet) const {
  for (int k = 0; k < packet.count; ++k) {
    packet.lux[k].setZero();
    packet.flicker_lux[k] = 0.0F;
    packet.flicker_lamp[k] = kNoLamp;
  }
  if (packet.count == 0) {
    return;
  }
  if (const auto* lamps = lampsNear(packet.position[0])) {
    for (const std::uint32_t lamp : *lamps) {
      addLamp(lamp, packet);
    }
  }
  if (scene_.daylight.present && (packet.position[0] - scene_.daylight.center).norm() < 40.0F) {
    addDaylight(packet);
  }
}

}  // namespace parkade::sim
