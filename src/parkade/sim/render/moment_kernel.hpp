// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace parkade::sim {

// What moving objects do to the light of sixteen points at once, as plain arrays.

inline constexpr int kLightLanes = 16;
inline constexpr float kBeamReach = 30.0F;  ///< m

struct LightPoints {
  alignas(64) float x[kLightLanes];  ///< m
  float y[kLightLanes];
  float z[kLightLanes];
  float normal_x[kLightLanes];  ///< unit
  float normal_y[kLightLanes];
  float normal_z[kLightLanes];
};

/// A head lamp's beam.
struct BeamLight {
  float x = 0.0F;  ///< m, of the lamp
  float y = 0.0F;
  float z = 0.0F;
  float ahead_x = 1.0F;  ///< unit, where it shines
  float ahead_y = 0.0F;
  float ahead_z = 0.0F;
};

/// An object's shadow on the floor, as a rounded rectangle.
struct FloorShadow {
  float x = 0.0F;  ///< m, of its middle
  float y = 0.0F;
  float axis_x = 1.0F;  ///< unit, along its first side
  float axis_y = 0.0F;
  float half_x = 0.0F;  ///< m
  float half_y = 0.0F;
  float height = 1.0F;  ///< m, of the object
  float reach2 = 0.0F;  ///< m^2: no shadow beyond
};

/// Adds the lux that a head lamp brings to each point.
void addBeam(const BeamLight& beam, const LightPoints& points, float* lux);

/// Multiplies by the share of the floor's light that a shadow leaves at each place.
void castShadow(const FloorShadow& shadow, const float* x, const float* y, float* share);

}  // namespace parkade::sim
