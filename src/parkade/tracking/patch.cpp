// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/patch.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace parkade {
namespace {

constexpr double kWindowSigma = 5.0;     // px, of the Gaussian weight over the patch
constexpr double kMinVariance = 4.0;     // grey^2, flatter patches hold nothing to align
constexpr double kConvergedPx = 0.015;   // step at which the alignment stops
constexpr double kMaxStepPx = 3.0;       // a larger step is a failure
constexpr double kMinNoiseGrey = 1.0;    // an 8-bit camera is not quieter than this
constexpr double kPriorNoiseGrey = 4.0;  // grey levels, for the weight of the shape's prior

// Weights of the patch's pixels; they sum to 1.
const std::array<float, Patch::kCount>& weights() {
  static const std::array<float, Patch::kCount> kWeights = [] {
    std::array<float, Patch::kCount> w{};
    double sum = 0.0;
    int k = 0;
    for (int y = -Patch::kRadius; y <= Patch::kRadius; ++y) {
      for (int x = -Patch::kRadius; x <= Patch::kRadius; ++x, ++k) {
        const double g = std::exp(-0.5 * (x * x + y * y) / (kWindowSigma * kWindowSigma));
        w[static_cast<std::size_t>(k)] = static_cast<float>(g);
        sum += g;
      }
    }
    for (float& v : w) v = static_cast<float>(v / sum);
    return w;
  }();
  return kWeights;
}

// Pixels that count in full: (sum w)^2 / sum w^2.
double effectiveCount() {
  static const double kEffective = [] {
    double squares = 0.0;
    for (const float w : weights()) squares += static_cast<double>(w) * w;
    return 1.0 / squares;
  }();
  return kEffective;
}

}  // namespace

bool sampleGrid(const cv::Mat& image, const Eigen::Vector2d& pixel, const Eigen::Matrix2d& warp,
                int radius, double spacing, float* out) {
  const double reach = radius * spacing;
  const double reach_x = reach * (std::abs(warp(0, 0)) + std::abs(warp(0, 1)));
  const double reach_y = reach * (std::abs(warp(1, 0)) + std::abs(warp(1, 1)));
  if (!(pixel.x() - reach_x >= 0.0 && pixel.y() - reach_y >= 0.0 &&
        pixel.x() + reach_x < image.cols - 1.001 && pixel.y() + reach_y < image.rows - 1.001)) {
    return false;  // NaN ends here as well
  }
  const auto stride = static_cast<std::ptrdiff_t>(image.step[0]);
  const std::uint8_t* data = image.data;
  const float dx = static_cast<float>(warp(0, 0) * spacing);
  const float dy = static_cast<float>(warp(1, 0) * spacing);
  for (int y = -radius; y <= radius; ++y) {
    const double offset = y * spacing;
    float u = static_cast<float>(pixel.x() + warp(0, 1) * offset - warp(0, 0) * reach);
    float v = static_cast<float>(pixel.y() + warp(1, 1) * offset - warp(1, 0) * reach);
    for (int x = -radius; x <= radius; ++x, u += dx, v += dy, ++out) {
      // Sums in single precision may reach a hair below zero at the very border.
      const int iu = std::max(static_cast<int>(u), 0);
      const int iv = std::max(static_cast<int>(v), 0);
      const float fu = u - static_cast<float>(iu);
      const float fv = v - static_cast<float>(iv);
      const std::uint8_t* p = data + iv * stride + iu;
      const auto p00 = static_cast<float>(p[0]);
      const auto p01 = static_cast<float>(p[1]);
      const auto p10 = static_cast<float>(p[stride]);
      const auto p11 = static_cast<float>(p[stride + 1]);
      const float top = p00 + fu * (p01 - p00);
      const float bottom = p10 + fu * (p11 - p10);
      *out = top + fv * (bottom - top);
    }
  }
  return true;
}

std::shared_ptr<const Patch> Patch::sample(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  constexpr int kWide = kSize + 2;
  std::array<float, static_cast<std::size_t>(kWide) * kWide> wide{};
  if (!sampleGrid(image, pixel, Eigen::Matrix2d::Identity(), kRadius + 1, 1.0, wide.data())) {
    return nullptr;
  }
  auto patch = std::make_shared<Patch>();
  const auto& w = weights();
  // 1. Values and steepest descent images of (d11, d21, d12, d22, dx, dy).
  double mean = 0.0;
  std::size_t k = 0;
  for (int y = -kRadius; y <= kRadius; ++y) {
    for (int x = -kRadius; x <= kRadius; ++x, ++k) {
      const std::size_t c = static_cast<std::size_t>((y + kRadius + 1) * kWide + x + kRadius + 1);
      patch->values_[k] = wide[c];
      mean += static_cast<double>(w[k]) * wide[c];
      const float gx = 0.5F * (wide[c + 1] - wide[c - 1]);
      const float gy = 0.5F * (wide[c + kWide] - wide[c - kWide]);
      const auto fx = static_cast<float>(x);
      const auto fy = static_cast<float>(y);
      patch->descent_[0][k] = gx * fx;
      patch->descent_[1][k] = gy * fx;
      patch->descent_[2][k] = gx * fy;
      patch->descent_[3][k] = gy * fy;
      patch->descent_[4][k] = gx;
      patch->descent_[5][k] = gy;
    }
  }
  double variance = 0.0;
  for (k = 0; k < kCount; ++k) {
    patch->values_[k] -= static_cast<float>(mean);
    variance += static_cast<double>(w[k]) * patch->values_[k] * patch->values_[k];
  }
  if (variance < kMinVariance) return nullptr;
  patch->variance_ = variance;
  // 2. Project out offset and gain: what they explain is no motion.
  for (auto& image_of_parameter : patch->descent_) {
    double offset = 0.0;
    double gain = 0.0;
    for (k = 0; k < kCount; ++k) {
      offset += static_cast<double>(w[k]) * image_of_parameter[k];
      gain += static_cast<double>(w[k]) * image_of_parameter[k] * patch->values_[k];
    }
    gain /= variance;
    for (k = 0; k < kCount; ++k) {
      image_of_parameter[k] -= static_cast<float>(offset + gain * patch->values_[k]);
    }
  }
  // 3. Hessian, then the weights go into the descent images once and for all.
  for (int a = 0; a < 6; ++a) {
    for (int b = a; b < 6; ++b) {
      const auto& da = patch->descent_[static_cast<std::size_t>(a)];
      const auto& db = patch->descent_[static_cast<std::size_t>(b)];
      double sum = 0.0;
      for (k = 0; k < kCount; ++k) sum += static_cast<double>(w[k]) * da[k] * db[k];
      patch->hessian_(a, b) = sum;
      patch->hessian_(b, a) = sum;
    }
  }
  for (auto& image_of_parameter : patch->descent_) {
    for (k = 0; k < kCount; ++k) image_of_parameter[k] *= w[k];
  }
  return patch;
}

PatchAlignment Patch::align(const cv::Mat& image, const Eigen::Vector2d& pixel,
                            const Eigen::Matrix2d& warp, double affine_sigma,
                            int max_iterations) const {
  PatchAlignment result;
  result.pixel = pixel;
  result.warp = warp;
  const double effective = effectiveCount();
  // The prior on the shape, in units of the weighted mean that the Hessian is.
  const double prior =
      kPriorNoiseGrey * kPriorNoiseGrey / (effective * affine_sigma * affine_sigma);
  Eigen::Matrix<double, 6, 6> hessian = hessian_;
  hessian.topLeftCorner<4, 4>().diagonal().array() += prior;
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(hessian);
  if (solver.info() != Eigen::Success) return result;
  const auto& w = weights();
  Eigen::Vector4d shape_change = Eigen::Vector4d::Zero();
  Values seen;
  double residual_square = 0.0;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    if (!sampleGrid(image, result.pixel, result.warp, kRadius, 1.0, seen.data())) return result;
    // 1. Gain and offset that best explain the picture by the patch.
    float mean = 0.0F;
    for (std::size_t k = 0; k < kCount; ++k) mean += w[k] * seen[k];
    float cross = 0.0F;
    float square = 0.0F;
    for (std::size_t k = 0; k < kCount; ++k) {
      seen[k] -= mean;
      cross += w[k] * seen[k] * values_[k];
      square += w[k] * seen[k] * seen[k];
    }
    const double gain = cross / variance_;
    result.correlation = cross / std::sqrt(std::max(square * variance_, 1e-9));
    if (result.correlation < 0.1) return result;
    // 2. One step.
    const auto inverse_gain = static_cast<float>(1.0 / gain);
    for (std::size_t k = 0; k < kCount; ++k) seen[k] = seen[k] * inverse_gain - values_[k];
    Eigen::Matrix<double, 6, 1> rhs;
    for (std::size_t a = 0; a < 6; ++a) {
      float sum = 0.0F;
      for (std::size_t k = 0; k < kCount; ++k) sum += descent_[a][k] * seen[k];
      rhs[static_cast<Eigen::Index>(a)] = sum;
    }
    residual_square = std::max(0.0, square / (gain * gain) - variance_);
    rhs.head<4>() -= prior * shape_change;
    const Eigen::Matrix<double, 6, 1> step = solver.solve(rhs);
    shape_change += step.head<4>();
    Eigen::Matrix2d change = Eigen::Matrix2d::Identity();
    change(0, 0) += step[0];
    change(1, 0) += step[1];
    change(0, 1) += step[2];
    change(1, 1) += step[3];
    if (std::abs(change.determinant()) < 0.1) return result;
    result.warp = result.warp * change.inverse();
    const Eigen::Vector2d move = -(result.warp * step.tail<2>());
    if (!(move.norm() < kMaxStepPx)) return result;
    result.pixel += move;
    if (move.squaredNorm() < kConvergedPx * kConvergedPx) {
      result.converged = true;
      break;
    }
  }
  const double noise = std::max(residual_square, kMinNoiseGrey * kMinNoiseGrey);
  const Eigen::Matrix<double, 6, 6> covariance =
      solver.solve(Eigen::Matrix<double, 6, 6>::Identity()) * (noise / effective);
  const Eigen::Matrix2d position =
      result.warp * covariance.bottomRightCorner<2, 2>() * result.warp.transpose();
  result.sigma_px = std::sqrt(0.5 * position.trace());
  return result;
}

}  // namespace parkade
