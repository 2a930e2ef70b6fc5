// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/bev/floor_elevation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/geometry/robust.hpp"

namespace parkade {
namespace {

// Information of "the sum of factor times height over these nodes is as said", lower half.
template <typename Add>
void addTerm(const int (&nodes)[4], const double (&factors)[4], double information, Add&& add) {
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      if (nodes[a] >= nodes[b]) add(nodes[a], nodes[b], information * factors[a] * factors[b]);
    }
  }
}

}  // namespace

void FloorElevation::addBends() {
  constexpr double kLeastCurvature = 1e-5;  // 1/m
  const double f = 1.0 / (std::max(kLeastCurvature, options_.curvature_sigma) * kStep * kStep);
  const double mixed = std::sqrt(2.0) * f;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const int n = i * kSide + j;
      for (const auto& [step, inside] :
           {std::pair(kSide, i + 2 < kSide), std::pair(1, j + 2 < kSide)}) {
        if (!inside) continue;
        bends_.push_back({{n, n + step, n + 2 * step, n + 2 * step}, {f, -2.0 * f, f, 0.0}});
      }
      if (i + 1 == kSide || j + 1 == kSide) continue;
      bends_.push_back({{n, n + kSide, n + 1, n + kSide + 1}, {mixed, -mixed, -mixed, mixed}});
    }
  }
}

void FloorElevation::addSlopes(std::vector<Eigen::Triplet<double>>& terms) const {
  const double information = std::pow(options_.slope_sigma * kStep, -2.0);
  for (int n = 0; n < kSide * kSide; ++n) {
    for (const int next : {n + kSide, n % kSide + 1 < kSide ? n + 1 : kSide * kSide}) {
      if (next >= kSide * kSide) continue;
      terms.emplace_back(n, n, information);
      terms.emplace_back(next, next, information);
      terms.emplace_back(next, n, -information);
    }
  }
}

FloorElevation::FloorElevation(const FloorElevationOptions& options) : options_(options) {
  addBends();
  std::vector<Eigen::Triplet<double>> terms;
  addSlopes(terms);
  for (const Bend& bend : bends_) {  // their places in the matrix
    addTerm(bend.nodes, bend.factors, 0.0,
            [&](int row, int column, double value) { terms.emplace_back(row, column, value); });
  }
  slopes_.resize(kSide * kSide, kSide * kSide);
  slopes_.setFromTriplets(terms.begin(), terms.end());
  solver_.analyzePattern(slopes_);
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

double FloorElevation::heightIn(const SE3& T_odom_frame, const Eigen::Vector2d& p) const {
  Eigen::Vector3d p_frame(p.x(), p.y(), 0.0);
  const Eigen::Vector3d up = T_odom_frame.rotation() * Eigen::Vector3d::UnitZ();
  for (int k = 0; k < 2; ++k) {  // the second step changes little
    const Eigen::Vector3d p_odom = T_odom_frame * p_frame;
    p_frame.z() += (at(p_odom.head<2>()) - p_odom.z()) / up.z();
  }
  return p_frame.z();
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
  constexpr int kIterations = 4;     // the lattice of the frame before is near
  constexpr double kSample = 1.5;    // scale of Cauchy's weight
  constexpr double kStanding = 2.0;  // what lies above the floor may be no floor, below hardly
  constexpr double kBend = 1.0;
  std::vector<Weights> weights;
  for (const FloorSample& s : samples) weights.push_back(weightsAt(s.p_odom.head<2>()));
  Eigen::SparseMatrix<double> H = slopes_;
  const auto add = [&H](int row, int column, double value) { H.coeffRef(row, column) += value; };
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::copy(slopes_.valuePtr(), slopes_.valuePtr() + slopes_.nonZeros(), H.valuePtr());
    for (const Bend& bend : bends_) {
      double bent = 0.0;
      for (int n = 0; n < 4; ++n) bent += bend.factors[n] * heights_[bend.nodes[n]];
      addTerm(bend.nodes, bend.factors, cauchy(bent * bent, kBend).weight, add);
    }
    Eigen::VectorXd b = Eigen::VectorXd::Zero(kSide * kSide);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Weights& w = weights[k];
      double off = samples[k].p_odom.z();
      for (int n = 0; n < 4; ++n) off -= w.share[n] * heights_[w.node[n]];
      const double error = (off > 0.0 ? kStanding : 1.0) * off / samples[k].sigma;
      const double information = (k < firm ? 1.0 : cauchy(error * error, kSample).weight) /
                                 (samples[k].sigma * samples[k].sigma);
      for (int n = 0; n < 4; ++n) b[w.node[n]] += information * w.share[n] * samples[k].p_odom.z();
      addTerm(w.node, w.share, information, add);
    }
    solver_.factorize(H);
    heights_ = solver_.solve(b);
  }
}

void FloorElevation::update(const SE3& T_odom_vehicle, const Eigen::Vector3d& plane,
                            const std::vector<FloorSample>& samples, const RestSigma& rest) {
  move(T_odom_vehicle, plane);
  constexpr double kWheels = 3.0;  // m ahead, behind and beside: as if these touched the floor
  const double rest_sigma = std::hypot(rest.height, kWheels * rest.tilt);
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
