// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/bev/floor_elevation.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

namespace parkade {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

// Information of "the sum of factor times height over these nodes is 0", lower half.
void addTerm(std::initializer_list<std::pair<int, double>> nodes, double information,
             Triplets& out) {
  for (const auto& [i, a] : nodes) {
    for (const auto& [j, b] : nodes) {
      if (i >= j) out.emplace_back(i, j, information * a * b);
    }
  }
}

}  // namespace

FloorElevation::FloorElevation(const FloorElevationOptions& options) : options_(options) {
  constexpr double kLeastCurvature = 1e-5;  // 1/m
  const double bend = std::max(kLeastCurvature, options.curvature_sigma) * kStep * kStep;
  const double rise = options.slope_sigma * kStep;
  const auto index = [](int i, int j) { return i * kSide + j; };
  Triplets terms;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const int n = index(i, j);
      for (const int next : {i + 1 < kSide ? index(i + 1, j) : -1, j + 1 < kSide ? n + 1 : -1}) {
        if (next >= 0) addTerm({{n, 1.0}, {next, -1.0}}, 1.0 / (rise * rise), terms);
      }
      if (i + 2 < kSide) {
        addTerm({{n, 1.0}, {index(i + 1, j), -2.0}, {index(i + 2, j), 1.0}}, 1.0 / (bend * bend),
                terms);
      }
      if (j + 2 < kSide) {
        addTerm({{n, 1.0}, {n + 1, -2.0}, {n + 2, 1.0}}, 1.0 / (bend * bend), terms);
      }
      if (i + 1 < kSide && j + 1 < kSide) {
        const int across = index(i + 1, j);
        addTerm({{n, 1.0}, {across, -1.0}, {n + 1, -1.0}, {across + 1, 1.0}}, 2.0 / (bend * bend),
                terms);
      }
    }
  }
  prior_.resize(kSide * kSide, kSide * kSide);
  prior_.setFromTriplets(terms.begin(), terms.end());
  solver_.analyzePattern(prior_);
}

FloorElevation::Weights FloorElevation::weightsAt(const Eigen::Vector2d& p_odom) const {
  const auto split = [](double place, double& rest) {
    const double at = std::clamp(place, 0.0, kSide - 1.0);
    const int i = std::min(static_cast<int>(at), kSide - 2);
    rest = at - i;
    return i;
  };
  double a = 0.0;
  double b = 0.0;
  const int i = split(p_odom.x() / kStep - first_.x(), a);
  const int j = split(p_odom.y() / kStep - first_.y(), b);
  const int n = i * kSide + j;
  return {{n, n + 1, n + kSide, n + kSide + 1},
          {(1.0 - a) * (1.0 - b), (1.0 - a) * b, a * (1.0 - b), a * b}};
}

double FloorElevation::at(const Eigen::Vector2d& p_odom) const {
  const Weights w = weightsAt(p_odom);
  double height = 0.0;
  for (int k = 0; k < 4; ++k) height += w.share[k] * heights_[w.node[k]];
  return height;
}

double FloorElevation::inVehicle(const SE3& T_odom_vehicle, const Eigen::Vector2d& p) const {
  Eigen::Vector3d p_vehicle(p.x(), p.y(), 0.0);
  const Eigen::Vector3d up = T_odom_vehicle.rotation() * Eigen::Vector3d::UnitZ();
  for (int k = 0; k < 2; ++k) {  // the floor is nearly level: the second step changes little
    const Eigen::Vector3d p_odom = T_odom_vehicle * p_vehicle;
    p_vehicle.z() += (at(p_odom.head<2>()) - p_odom.z()) / up.z();
  }
  return p_vehicle.z();
}

void FloorElevation::move(const SE3& T_odom_vehicle, const Eigen::Vector3d& plane) {
  const Eigen::Vector3d place = T_odom_vehicle.translation();
  const Eigen::Vector2i first(static_cast<int>(std::lround(place.x() / kStep)) - kHalf,
                              static_cast<int>(std::lround(place.y() / kStep)) - kHalf);
  if (!isEmpty() && first == first_) return;
  const Eigen::Vector3d normal =
      T_odom_vehicle.rotation() * Eigen::Vector3d(-plane.x(), -plane.y(), 1.0);
  const Eigen::Vector3d foot = T_odom_vehicle * Eigen::Vector3d(0.0, 0.0, plane.z());
  Eigen::VectorXd heights(kSide * kSide);
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Eigen::Vector2d p = kStep * (first + Eigen::Vector2i(i, j)).cast<double>();
      const Eigen::Vector2i before = first + Eigen::Vector2i(i, j) - first_;
      const bool known = !isEmpty() && before.minCoeff() >= 0 && before.maxCoeff() < kSide;
      heights[i * kSide + j] =
          known ? heights_[before.x() * kSide + before.y()]
                : foot.z() - (normal.head<2>().dot(p - foot.head<2>())) / normal.z();
    }
  }
  first_ = first;
  heights_ = std::move(heights);
}

// firm: so many of the first samples are believed whatever the others say.
void FloorElevation::solve(const std::vector<FloorSample>& samples, std::size_t firm) {
  constexpr int kIterations = 4;  // the lattice of the frame before is near
  constexpr double kScale = 1.5;  // of Cauchy's weight, in sigmas
  std::vector<Weights> weights;
  for (const FloorSample& s : samples) weights.push_back(weightsAt(s.p_odom.head<2>()));
  Eigen::SparseMatrix<double> H = prior_;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::copy(prior_.valuePtr(), prior_.valuePtr() + prior_.nonZeros(), H.valuePtr());
    Eigen::VectorXd b = Eigen::VectorXd::Zero(kSide * kSide);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Weights& w = weights[k];
      double off = samples[k].p_odom.z();
      for (int n = 0; n < 4; ++n) off -= w.share[n] * heights_[w.node[n]];
      const double whitened = off / samples[k].sigma;
      const double trust = k < firm ? 1.0 : 1.0 / (1.0 + whitened * whitened / (kScale * kScale));
      const double information = trust / (samples[k].sigma * samples[k].sigma);
      for (int n = 0; n < 4; ++n) {
        b[w.node[n]] += information * w.share[n] * samples[k].p_odom.z();
        for (int m = 0; m <= n; ++m) {
          H.coeffRef(w.node[n], w.node[m]) += information * w.share[n] * w.share[m];
        }
      }
    }
    solver_.factorize(H);
    heights_ = solver_.solve(b);
  }
}

void FloorElevation::update(const SE3& T_odom_vehicle, const Eigen::Vector3d& plane,
                            const std::vector<FloorSample>& samples, double rest_sigma) {
  move(T_odom_vehicle, plane);
  constexpr double kWheels = 3.0;  // m ahead, behind and beside
  std::vector<FloorSample> used;
  for (const double x : {-kWheels, kWheels}) {
    for (const double y : {-kWheels, kWheels}) {
      used.push_back({T_odom_vehicle * Eigen::Vector3d(x, y, 0.0), rest_sigma});
    }
  }
  const std::size_t firm = used.size();
  for (const FloorSample& s : samples) {
    if (std::abs(s.p_odom.z() - at(s.p_odom.head<2>())) < options_.max_off_m) used.push_back(s);
  }
  solve(used, firm);
}

}  // namespace parkade
