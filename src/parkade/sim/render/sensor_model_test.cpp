// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/sensor_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/sim/render/texture.hpp"

namespace parkade::sim {
namespace {

Radiance flat(double nits, int width = 256, int height = 256) {
  Radiance radiance;
  radiance.width = width;
  radiance.height = height;
  radiance.pixels.assign(static_cast<std::size_t>(width) * height,
                         Eigen::Vector3f::Constant(static_cast<float>(nits)));
  return radiance;
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

/// Of the linear level (sRGB undone) of one channel.
Moments linearMoments(const cv::Mat& image, int channel) {
  Moments m;
  double sum = 0.0;
  double squares = 0.0;
  const int n = image.rows * image.cols;
  for (int i = 0; i < n; ++i) {
    const double x = linearOfSrgb(image.at<cv::Vec3b>(i / image.cols, i % image.cols)[channel]);
    sum += x;
    squares += x * x;
  }
  m.mean = sum / n;
  m.variance = squares / n - m.mean * m.mean;
  return m;
}

TEST(SensorModel, PhotonTransferCurve) {
  // Var = (mean level) * gain / full well + (read noise * gain / full well)^2, in units of the
  // full scale: the slope of variance against mean is the conversion gain.
  SensorOptions options;
  const SensorModel sensor(options);
  for (const double gain : {1.0, 4.0, 16.0}) {
    for (const double level : {0.08, 0.2, 0.4, 0.6}) {
      const double electrons = level * options.full_well / gain;
      const Exposure exposure{0.01, gain};
      const double nits = electrons / (sensor.electronsPerNitSecond() * exposure.time_s);
      const Moments m = linearMoments(sensor.expose(flat(nits), exposure, {}, 99, 1), 1);
      const double per_electron = sensor.levelOf(1.0, gain);
      // 8-bit sRGB rounds with a step of 1/255 over the response's slope.
      const double slope = 1.055 / 2.4 * std::pow(level, 1.0 / 2.4 - 1.0);
      const double rounding = 1.0 / (255.0 * slope) / (255.0 * slope) / 12.0;
      const double expected =
          (electrons + options.read_noise * options.read_noise) * per_electron * per_electron +
          rounding;
      EXPECT_NEAR(m.mean, level, 0.01 * level) << "gain " << gain;
      EXPECT_NEAR(m.variance, expected, 0.05 * expected) << "gain " << gain << " level " << level;
    }
  }
}

TEST(SensorModel, NoiseOffIsFlat) {
  SensorOptions options;
  options.noise = false;
  const SensorModel sensor(options);
  const Moments m = linearMoments(sensor.expose(flat(20.0), {0.01, 2.0}, {}, 1, 1), 1);
  EXPECT_LT(m.variance, 1e-9);
}

TEST(SensorModel, ExposureFirstThenGainThenDark) {
  const SensorOptions options;
  const SensorModel sensor(options);
  double last_variance = 0.0;
  double last_time = 0.0;
  for (const double lux : {1000.0, 200.0, 50.0, 10.0}) {
    const double nits = lux * 0.25 / M_PI;  // a grey floor in that light
    const Exposure e = sensor.meter(flat(nits));
    EXPECT_GE(e.time_s, options.min_exposure_ms * 1e-3);
    EXPECT_LE(e.time_s, options.max_exposure_ms * 1e-3);
    EXPECT_LE(e.gain, options.max_gain);
    if (e.gain > 1.0) {
      EXPECT_DOUBLE_EQ(e.time_s, options.max_exposure_ms * 1e-3);
    }
    const Moments m = linearMoments(sensor.expose(flat(nits), e, {}, 7, 1), 1);
    if (lux > 20.0) {
      EXPECT_NEAR(m.mean, options.target, 0.03 * options.target) << lux;
    } else {  // at the limit of both
      EXPECT_GT(m.mean, 0.5 * options.target) << lux;
    }
    EXPECT_GE(e.time_s, last_time);
    EXPECT_GT(m.variance, last_variance) << lux << ": less light, more noise";
    last_time = e.time_s;
    last_variance = m.variance;
  }
  // Far below what the sensor can lift, the picture stays dark.
  const Exposure e = sensor.meter(flat(0.005));
  EXPECT_DOUBLE_EQ(e.gain, options.max_gain);
  EXPECT_LT(linearMoments(sensor.expose(flat(0.005), e, {}, 7, 1), 1).mean, 0.5 * options.target);
}

TEST(SensorModel, VignettingFollowsItsLaw) {
  SensorOptions options;
  options.noise = false;
  const SensorModel sensor(options);
  const Radiance radiance = flat(40.0, 91, 1);
  std::vector<float> cosines;
  for (int i = 0; i <= 90; ++i) {
    cosines.push_back(static_cast<float>(std::cos(i * M_PI / 180.0)));
  }
  const cv::Mat image = sensor.expose(radiance, {0.01, 4.0}, sensor.lensShare(cosines), 0, 1);
  const double middle = linearOfSrgb(image.at<cv::Vec3b>(0, 0)[1]);
  double last = 2.0;
  for (const int angle : {0, 20, 40, 60, 80}) {
    const double c = std::cos(0.55 * angle * M_PI / 180.0);
    const double x = linearOfSrgb(image.at<cv::Vec3b>(0, angle)[1]);
    EXPECT_NEAR(x / middle, c * c * c * c, 0.02) << angle;
    EXPECT_LT(x, last);
    last = x;
  }
}

}  // namespace
}  // namespace parkade::sim
