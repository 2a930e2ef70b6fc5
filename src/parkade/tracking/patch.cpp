// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/patch.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "parkade/tracking/grid_sampling.hpp"

namespace parkade {
namespace {

constexpr double kWindowSigma = 5.0;     // px, of the Gaussian weight over the patch
constexpr double kMinVariance = 4.0;     // grey^2, flatter patches hold nothing to align
constexpr double kConvergedPx = 0.015;   // step at which the alignment stops
constexpr double kMaxStepPx = 3.0;       // a larger step is a failure
constexpr double kMinNoiseGrey = 1.0;    // an 8-bit camera is not quieter than this
constexpr double kPriorNoiseGrey = 4.0;  // grey levels, for the weight of the shape's prior

using Values = Eigen::Matrix<float, Patch::kCount, 1>;

// Weights of the patch's pixels; they sum to 1.
const Values& weights() {
  static const Values kWeights = [] {
    Values w;
    double sum = 0.0;
    int k = 0;
    for (int y = -Patch::kRadius; y <= Patch::kRadius; ++y) {
      for (int x = -Patch::kRadius; x <= Patch::kRadius; ++x, ++k) {
        const double g = std::exp(-0.5 * (x * x + y * y) / (kWindowSigma * kWindowSigma));
        w[k] = static_cast<float>(g);
        sum += g;
      }
    }
    w = (w.cast<double>() / sum).cast<float>();
    return w;
  }();
  return kWeights;
}

// Pixels that count in full: (sum w)^2 / sum w^2.
double effectiveCount() {
  static const double kEffective = 1.0 / weights().cast<double>().squaredNorm();
  return kEffective;
}

// Offset, gain and the slope of brightness along x and y of a patch with these values, orthonormal
// under the weights.
std::array<Values, 4> changesOfLight(const Values& values) {
  const Values& w = weights();
  std::array<Values, 4> changes;
  changes[0] = Values::Ones();
  changes[1] = values;
  int k = 0;
  for (int y = -Patch::kRadius; y <= Patch::kRadius; ++y) {
    for (int x = -Patch::kRadius; x <= Patch::kRadius; ++x, ++k) {
      changes[2][k] = static_cast<float>(x);
      changes[3][k] = static_cast<float>(y);
    }
  }
  for (std::size_t i = 0; i < changes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      changes[i] -= w.cwiseProduct(changes[j]).dot(changes[i]) * changes[j];
    const float size = std::sqrt(w.cwiseProduct(changes[i]).dot(changes[i]));
    changes[i] /= std::max(size, 1e-6F);
  }
  return changes;
}

}  // namespace

std::shared_ptr<const Patch> Patch::sample(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  constexpr int kWide = kSize + 2;
  std::array<float, static_cast<std::size_t>(kWide) * kWide> wide{};
  if (!sampleGrid(image, pixel, Eigen::Matrix2d::Identity(), kRadius + 1, wide.data())) {
    return nullptr;
  }
  auto patch = std::make_shared<Patch>();
  const Values& w = weights();
  // 1. Values and steepest descent images of (d11, d21, d12, d22, dx, dy).
  Eigen::Index k = 0;
  for (int y = -kRadius; y <= kRadius; ++y) {
    for (int x = -kRadius; x <= kRadius; ++x, ++k) {
      const auto c = static_cast<std::size_t>((y + kRadius + 1) * kWide + x + kRadius + 1);
      patch->values_[k] = wide[c];
      const float gx = 0.5F * (wide[c + 1] - wide[c - 1]);
      const float gy = 0.5F * (wide[c + kWide] - wide[c - kWide]);
      const auto fx = static_cast<float>(x);
      const auto fy = static_cast<float>(y);
      patch->descent_.row(k) << gx * fx, gy * fx, gx * fy, gy * fy, gx, gy;
    }
  }
  patch->values_.array() -= w.dot(patch->values_);
  const Values weighted = w.cwiseProduct(patch->values_);
  patch->variance_ = weighted.dot(patch->values_);
  if (patch->variance_ < kMinVariance) return nullptr;
  // 2. Project out what light explains: it is no motion.
  const std::array<Values, 4> changes = changesOfLight(patch->values_);
  for (int a = 0; a < 6; ++a) {
    auto descent = patch->descent_.col(a);
    for (const Values& change : changes) descent -= w.cwiseProduct(change).dot(descent) * change;
  }
  // 3. Hessian, then the weights go into the descent images once and for all.
  const Eigen::Matrix<float, kCount, 6> plain = patch->descent_;
  for (int a = 0; a < 6; ++a) patch->descent_.col(a).array() *= w.array();
  for (int a = 0; a < 6; ++a) {
    for (int b = a; b < 6; ++b) {
      patch->hessian_(a, b) = plain.col(a).dot(patch->descent_.col(b));
      patch->hessian_(b, a) = patch->hessian_(a, b);
    }
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
  const Values& w = weights();
  Eigen::Vector4d shape_change = Eigen::Vector4d::Zero();
  Values seen;
  double residual_square = 0.0;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    if (!sampleGrid(image, result.pixel, result.warp, kRadius, seen.data())) return result;
    // 1. Gain and offset that best explain the picture by the patch.
    seen.array() -= w.dot(seen);
    const Values weighted = w.cwiseProduct(seen);
    const float cross = weighted.dot(values_);
    const float square = weighted.dot(seen);
    const double gain = cross / variance_;
    result.correlation = cross / std::sqrt(std::max(square * variance_, 1e-9));
    if (result.correlation < 0.1) return result;
    // 2. One step.
    seen = seen * static_cast<float>(1.0 / gain) - values_;
    Eigen::Matrix<double, 6, 1> rhs;
    for (int a = 0; a < 6; ++a) rhs[a] = descent_.col(a).dot(seen);
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
