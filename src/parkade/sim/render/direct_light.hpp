// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/sim/render/tracer.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

inline constexpr std::uint16_t kNoLamp = 0xffffU;

/// What lamps and daylight bring to sixteen points at once, before any bounce. The points must lie
/// in one cell of DirectLight::cellOf, or within a few metres of each other.
struct DirectPacket {
  int count = 0;  ///< points used, up to 16
  Eigen::Vector3f position[kPacket];
  Eigen::Vector3f normal[kPacket];
  std::uint64_t random[kPacket];  ///< any number of the point's own; picks places on the lamps
  // Results:
  Eigen::Vector3f lux[kPacket];         ///< illuminance per colour channel
  float flicker_lux[kPacket];           ///< of the strongest flickering lamp, luminance
  std::uint16_t flicker_lamp[kPacket];  ///< its index, or kNoLamp
};

/// Luminaires as line lights: points along the tube, each with a cosine lobe downwards, and a small
/// share upwards, as bare tubes have. E = I cos(theta) / d^2, with shadow rays.
class DirectLight {
 public:
  DirectLight(const Scene& scene, const StaticTracer& tracer);
  /// The cell, some metres wide, that a point lies in.
  [[nodiscard]] static std::uint64_t cellOf(const Eigen::Vector3f& p);
  /// Fills the results of the packet. Thread-safe.
  void gather(DirectPacket& packet) const;

 private:
  void addLamp(std::uint32_t lamp, DirectPacket& packet) const;
  void addDaylight(DirectPacket& packet) const;
  [[nodiscard]] const std::vector<std::uint32_t>* lampsNear(const Eigen::Vector3f& p) const;

  const Scene& scene_;
  const StaticTracer& tracer_;
  Eigen::Vector2f grid_min_ = Eigen::Vector2f::Zero();
  int grid_nx_ = 0;
  int grid_ny_ = 0;
  std::vector<std::vector<std::uint32_t>> lamps_of_cell_;
};

/// Luminance of a linear colour (Rec. 709).
inline float luminance(const Eigen::Vector3f& rgb) {
  return 0.2126F * rgb.x() + 0.7152F * rgb.y() + 0.0722F * rgb.z();
}

}  // namespace parkade::sim
