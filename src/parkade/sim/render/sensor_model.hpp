// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/sim/render/frame.hpp"

namespace parkade::sim {

/// A small automotive image sensor behind a fast wide lens. Derivation: docs/math/rendering.md.
struct SensorOptions {
  bool noise = true;
  bool vignetting = true;
  double f_number = 2.0;
  double pixel_um = 3.0;
  double quantum_efficiency = 0.6;
  double full_well = 10000.0;
  double read_noise = 3.0;
  double min_exposure_ms = 0.05;
  double max_exposure_ms = 20.0;
  double max_gain = 24.0;
  double target = 0.13;
  double fixed_exposure_ms = 0.0;
  double fixed_gain = 1.0;
  int motion_blur = 1;
  void visit(OptionVisitor& v) {
    v.field("noise", noise, "Photon and read noise.");
    v.field("vignetting", vignetting, "Darker image towards the border of the lens.");
    v.field("f_number", f_number, "", "Focal length over aperture.", 0.5, 32.0);
    v.field("pixel_um", pixel_um, "um", "Side of a pixel.", 0.5, 20.0);
    v.field("quantum_efficiency", quantum_efficiency, "", "Electrons per photon in green.", 0.01,
            1.0);
    v.field("full_well", full_well, "electrons", "Charge that saturates a pixel at gain 1.", 100.0,
            1e6);
    v.field("read_noise", read_noise, "electrons", "Standard deviation of the read-out.", 0.0,
            100.0);
    v.field("min_exposure_ms", min_exposure_ms, "ms", "Shortest exposure.", 0.001, 100.0);
    v.field("max_exposure_ms", max_exposure_ms, "ms", "Longest exposure.", 0.01, 100.0);
    v.field("max_gain", max_gain, "", "Largest gain, used when the exposure is longest.", 1.0,
            256.0);
    v.field("target", target, "", "Linear level that the picture's typical light is put at.", 0.01,
            0.9);
    v.field("fixed_exposure_ms", fixed_exposure_ms, "ms", "Exposure without control; 0: control.",
            0.0, 100.0);
    v.field("fixed_gain", fixed_gain, "", "Gain where the exposure is fixed.", 1.0, 256.0);
    v.field("motion_blur", motion_blur, "count", "Sub-frames within the exposure; 1: none.", 1, 64);
  }
};

struct Exposure {
  double time_s = 0.01;
  double gain = 1.0;
};

/// Turns radiance into the bytes of a picture. Deterministic: noise depends on the key alone.
class SensorModel {
 public:
  explicit SensorModel(const SensorOptions& options);

  /// The settled state of exposure control for a picture: its geometric mean luminance is put at
  /// the target level, by time first, then by gain, within their limits.
  [[nodiscard]] Exposure meter(const Radiance& radiance) const;

  /// Digital picture, CV_8UC3 BGR. lens_share: what the lens leaves of each pixel's light (see
  /// lensShare); empty: all. key: any number that names the picture.
  [[nodiscard]] cv::Mat expose(const Radiance& radiance, const Exposure& exposure,
                               const std::vector<float>& lens_share, std::uint64_t key,
                               int threads) const;

  /// Electrons per second that a luminance of 1 cd/m^2 (white) frees in a green pixel on the axis.
  [[nodiscard]] double electronsPerNitSecond() const { return electrons_per_nit_s_; }
  /// Linear level, 0 to 1, of a number of green electrons at a gain, without noise and limits.
  [[nodiscard]] double levelOf(double electrons, double gain) const {
    return electrons * gain / options_.full_well;
  }
  /// Share of the light left by the lens at an angle from the axis.
  [[nodiscard]] static double vignette(double axis_cosine);
  /// The share for each pixel's cosine from the axis; all 1 where vignetting is switched off.
  [[nodiscard]] std::vector<float> lensShare(const std::vector<float>& axis_cosines) const;
  [[nodiscard]] const SensorOptions& options() const { return options_; }

 private:
  SensorOptions options_;
  double electrons_per_nit_s_;
  std::vector<std::uint8_t> response_;  ///< 8-bit sRGB of a 12-bit linear level
};

}  // namespace parkade::sim
