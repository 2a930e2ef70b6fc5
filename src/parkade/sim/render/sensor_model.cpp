// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/sensor_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/sensor_kernel.hpp"
#include "parkade/sim/render/texture.hpp"

namespace parkade::sim {
namespace {

constexpr int kLevels = 4096;  // 12-bit converter
constexpr double kTransmission = 0.9;
/// Photons per square metre for 1 lux second of white light: 1 / 683 J at 555 nm is 4.1e15, and
/// white light carries about 2.5 times that over the visible band.
constexpr double kPhotonsPerLuxSecond = 1.0e16;
/// What a colour filter passes of white light, against no filter: red, green, blue.
constexpr std::array<double, 3> kFilter{0.24, 0.32, 0.21};
/// The image circle of a wide lens dims less than cos^4 of the field angle: its pupil grows.
constexpr double kPupil = 0.55;

/// Medians of 4096 equally likely parts of the standard normal distribution, scaled to unit
/// variance.
const std::array<float, kLevels>& normalQuantiles() {
  static const std::array<float, kLevels> kTable = [] {
    std::array<double, kLevels> z{};
    double sum = 0.0;
    for (int i = 0; i < kLevels; ++i) {
      const double p = (i + 0.5) / kLevels;
      double x = 0.0;
      for (int k = 0; k < 60; ++k) {  // Newton on the distribution function
        const double f = 0.5 * std::erfc(-x / std::numbers::sqrt2) - p;
        const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
        x -= std::clamp(f / density, -0.5, 0.5);
      }
      z[static_cast<std::size_t>(i)] = x;
      sum += x * x;
    }
    std::array<float, kLevels> table{};
    const double scale = 1.0 / std::sqrt(sum / kLevels);
    std::transform(z.begin(), z.end(), table.begin(),
                   [scale](double x) { return static_cast<float>(x * scale); });
    return table;
  }();
  return kTable;
}

}  // namespace

SensorModel::SensorModel(const SensorOptions& options) : options_(options) {
  // E_sensor = pi L T / (4 N^2), electrons = E t * photons * pixel area * filter * QE.
  const double lux_per_nit =
      std::numbers::pi * kTransmission / (4.0 * options.f_number * options.f_number);
  const double area = options.pixel_um * options.pixel_um * 1e-12;
  electrons_per_nit_s_ =
      lux_per_nit * kPhotonsPerLuxSecond * area * kFilter[1] * options.quantum_efficiency;
  response_.resize(kLevels);
  for (int i = 0; i < kLevels; ++i) {
    const float level = static_cast<float>(i) / (kLevels - 1);
    response_[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(std::lround(255.0F * srgbOfLinear(level)));
  }
}

double SensorModel::vignette(double axis_cosine) {
  const double c = std::cos(kPupil * std::acos(std::clamp(axis_cosine, -1.0, 1.0)));
  return c * c * c * c;
}

std::vector<float> SensorModel::lensShare(const std::vector<float>& axis_cosines) const {
  std::vector<float> share(axis_cosines.size(), 1.0F);
  if (options_.vignetting) {
    std::transform(axis_cosines.begin(), axis_cosines.end(), share.begin(),
                   [](float cosine) { return static_cast<float>(vignette(cosine)); });
  }
  return share;
}

Exposure SensorModel::meter(const Radiance& radiance) const {
  if (options_.fixed_exposure_ms > 0.0) {
    return {options_.fixed_exposure_ms * 1e-3, options_.fixed_gain};
  }
  double sum = 0.0;
  std::size_t count = 0;
  constexpr std::size_t kStep = 7;  // every seventh pixel; 7 divides no usual image width
  for (std::size_t i = 0; i < radiance.pixels.size(); i += kStep) {
    const float y = luminance(radiance.pixels[i]);
    if (y > 0.0F) {
      sum += std::log(static_cast<double>(y) + 1e-3);
      ++count;
    }
  }
  const double typical = count > 0 ? std::exp(sum / static_cast<double>(count)) : 1.0;
  // Wanted product of seconds and gain:
  const double wanted = options_.target * options_.full_well / (typical * electrons_per_nit_s_);
  Exposure exposure;
  exposure.time_s =
      std::clamp(wanted, options_.min_exposure_ms * 1e-3, options_.max_exposure_ms * 1e-3);
  exposure.gain = std::clamp(wanted / exposure.time_s, 1.0, options_.max_gain);
  return exposure;
}

cv::Mat SensorModel::expose(const Radiance& radiance, const Exposure& exposure,
                            const std::vector<float>& lens_share, std::uint64_t key,
                            int threads) const {
  const int width = radiance.width;
  const int height = radiance.height;
  PARKADE_CHECK(lens_share.empty() || lens_share.size() == radiance.pixels.size(),
                "{} shares for {} pixels", lens_share.size(), radiance.pixels.size());
  cv::Mat image(height, width, CV_8UC3);
  const std::uint64_t mixed = hash64(key, 0x5e45);
  // Red and blue filters pass less light; white balance lifts them, and their noise, again.
  std::array<float, 3> electrons{};
  std::array<float, 3> level{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double sensitivity = kFilter[c] / kFilter[1];
    electrons[c] = static_cast<float>(electrons_per_nit_s_ * exposure.time_s * sensitivity);
    level[c] = static_cast<float>((kLevels - 1) * levelOf(1.0, exposure.gain) / sensitivity);
  }
  std::vector<float> level_row(3U * width);
  for (std::size_t i = 0; i < level_row.size(); ++i) {
    level_row[i] = level[i % 3];
  }
  const auto& quantiles = normalQuantiles();
  parallelFor(threads, static_cast<std::size_t>(height), [&](std::size_t y) {
    thread_local std::vector<float> electrons_row;
    thread_local std::vector<std::uint8_t> bytes;
    electrons_row.resize(3U * width);
    bytes.resize(3U * width);
    for (int x = 0; x < width; ++x) {
      const float share = lens_share.empty() ? 1.0F : lens_share[y * width + x];
      for (std::size_t c = 0; c < 3; ++c) {
        electrons_row[3U * x + c] = share * electrons[c];
      }
    }
    SensorRow row;
    row.radiance = radiance.pixels[y * width].data();
    row.electrons_per_nit = electrons_row.data();
    row.level_per_electron = level_row.data();
    row.quantiles = quantiles.data();
    row.response = response_.data();
    row.read_variance = static_cast<float>(options_.read_noise * options_.read_noise);
    row.noise = options_.noise ? 1.0F : 0.0F;
    row.key = static_cast<std::uint32_t>(mixed >> 32U);
    row.first = static_cast<std::uint32_t>(mixed) + static_cast<std::uint32_t>(y) * 3U * width;
    row.values = 3 * width;
    row.out = bytes.data();
    exposeRow(row);
    std::uint8_t* out = image.ptr<std::uint8_t>(static_cast<int>(y));
    for (int x = 0; x < width; ++x) {
      out[3 * x] = bytes[3U * x + 2];
      out[3 * x + 1] = bytes[3U * x + 1];
      out[3 * x + 2] = bytes[3U * x];
    }
  });
  return image;
}

}  // namespace parkade::sim
