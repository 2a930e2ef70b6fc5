// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/moment_kernel.hpp"

#include "parkade/core/isa_clones.hpp"

namespace parkade::sim {
namespace {

constexpr float kBeamCandela = 4000.0F;  // dipped, below the cut-off
constexpr float kBeamEdge = 0.7F;        // cosine of the lobe's half angle
constexpr float kDarkest = 0.12F;        // light left below the middle of a car

inline float positive(float x) {
  return x < 0.0F ? -x : x;
}
inline float atLeast(float x, float low) {
  return x < low ? low : x;
}
inline float atMost(float x, float high) {
  return high < x ? high : x;
}

}  // namespace

PARKADE_ISA_CLONES
void addBeam(const BeamLight& beam, const LightPoints& points, float* lux) {
  for (int k = 0; k < kLightLanes; ++k) {
    const float x = points.x[k] - beam.x;
    const float y = points.y[k] - beam.y;
    const float z = points.z[k] - beam.z;
    const float ahead = x * beam.ahead_x + (y * beam.ahead_y + z * beam.ahead_z);
    const float d2 = x * x + (y * y + z * z);
    const float inverse = 1.0F / __builtin_sqrtf(atLeast(d2, 0.04F));
    const float along_normal =
        x * points.normal_x[k] + (y * points.normal_y[k] + z * points.normal_z[k]);
    const float cos_surface = -along_normal * inverse;
    // A wide lobe, cut off above the horizon as a dipped beam is.
    const float lobe = atLeast(ahead * inverse - kBeamEdge, 0.0F) / (1.0F - kBeamEdge);
    const float cut = atMost(atLeast((0.03F - z * inverse) / 0.06F, 0.08F), 1.0F);
    const float value = kBeamCandela * lobe * lobe * lobe * cut * cos_surface * inverse * inverse;
    const int outside = (ahead <= 0.0F ? 1 : 0) |
                        (ahead * ahead < kBeamEdge * kBeamEdge * d2 ? 1 : 0) |
                        (d2 > kBeamReach * kBeamReach ? 1 : 0) | (cos_surface <= 0.0F ? 1 : 0);
    lux[k] += outside != 0 ? 0.0F : value;
  }
}

PARKADE_ISA_CLONES
void castShadow(const FloorShadow& shadow, const float* x, const float* y, float* share) {
  for (int k = 0; k < kLightLanes; ++k) {
    const float dx = x[k] - shadow.x;
    const float dy = y[k] - shadow.y;
    const float along = positive(dx * shadow.axis_x + dy * shadow.axis_y) - shadow.half_x;
    const float across = positive(shadow.axis_x * dy - shadow.axis_y * dx) - shadow.half_y;
    const float a = atLeast(along, 0.0F);
    const float c = atLeast(across, 0.0F);
    const float outside = __builtin_sqrtf(a * a + c * c);
    const float inside = atMost(along < across ? across : along, 0.0F);  // negative below it
    // Half dark at the edge, dark 0.4 m further in, free at its height's distance.
    const float depth = atMost(atLeast(-inside / 0.4F, 0.0F), 1.0F);
    const float fade = atLeast(1.0F - outside / shadow.height, 0.0F);
    const float dark = 0.5F * fade * fade * fade + 0.5F * depth * (2.0F - depth);
    const int beyond = (dx * dx + dy * dy > shadow.reach2 ? 1 : 0) |
                       (along > shadow.height ? 1 : 0) | (across > shadow.height ? 1 : 0);
    share[k] *= beyond != 0 ? 1.0F : 1.0F - (1.0F - kDarkest) * dark;
  }
}

}  // namespace parkade::sim
