// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>

#include <memory>

namespace parkade::sim {

// Embree's handles as values that release themselves.

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, EmbreeRelease>;

/// Which parts of the scene a ray sees: bits of Embree's ray mask.
enum RayMask : unsigned {
  kMaskSolid = 1U,     ///< structure, cars, everything not below
  kMaskFloor = 2U,     ///< materials with is_floor
  kMaskOverhead = 4U,  ///< ceiling, beams, hanging signs
  kMaskLamp = 8U,      ///< emitting materials of the ceiling
  kMaskMoving = 16U,   ///< instances of what moves, but for the own car
  kMaskOwnCar = 32U,   ///< that of the own car
  kMaskAll = 63U,
};

/// A device that builds on one thread, so that the order of triangles in its trees, and with it the
/// choice between two triangles hit at the same distance, is the same on every machine.
EmbreeDevice makeEmbreeDevice();

/// Numbers close to zero count as zero while this object lives: Embree is several times slower
/// with denormal numbers. The caller's setting is restored at the end.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

}  // namespace parkade::sim
