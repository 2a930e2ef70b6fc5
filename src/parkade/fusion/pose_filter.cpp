// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/fusion/pose_filter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

constexpr Eigen::Index kErrors = 4;  // x, y, angle, z

// The normal distribution's quantile (Acklam's rational approximation, relative error 1e-9).
double normalQuantile(double p) {
  PARKADE_CHECK(p > 0.0 && p < 1.0, "probability of {}", p);
  constexpr double kA[] = {-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                           1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr double kB[] = {-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02,
                           6.680131188771972e+01, -1.328068155288572e+01};
  constexpr double kC[] = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                           -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr double kD[] = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                           3.754408661907416e+00};
  constexpr double kTail = 0.02425;
  if (p < kTail || p > 1.0 - kTail) {
    const double q = std::sqrt(-2.0 * std::log(std::min(p, 1.0 - p)));
    const double x = (((((kC[0] * q + kC[1]) * q + kC[2]) * q + kC[3]) * q + kC[4]) * q + kC[5]) /
                     ((((kD[0] * q + kD[1]) * q + kD[2]) * q + kD[3]) * q + 1.0);
    return p < kTail ? x : -x;
  }
  const double q = p - 0.5;
  const double r = q * q;
  return (((((kA[0] * r + kA[1]) * r + kA[2]) * r + kA[3]) * r + kA[4]) * r + kA[5]) * q /
         (((((kB[0] * r + kB[1]) * r + kB[2]) * r + kB[3]) * r + kB[4]) * r + 1.0);
}

}  // namespace

double chiSquareQuantile(int degrees, double probability) {
  PARKADE_CHECK(degrees > 0, "{} degrees of freedom", degrees);
  const double z = normalQuantile(probability);
  if (degrees == 1) {
    const double two_sided = normalQuantile(0.5 + 0.5 * probability);
    return two_sided * two_sided;
  }
  if (degrees == 2) return -2.0 * std::log(1.0 - probability);
  const double k = 2.0 / (9.0 * degrees);
  return degrees * std::pow(1.0 - k + z * std::sqrt(k), 3.0);
}

PoseFilter::PoseFilter(const GroundPose& pose, const Matrix4& covariance)
    : poses_{pose}, P_(covariance) {}

void PoseFilter::predict(const SE2& T_before_after, double dz, const Matrix4& covariance) {
  poses_[0].T_world_vehicle = poses_[0].T_world_vehicle * T_before_after;
  poses_[0].z += dz;
  Matrix4 F = Matrix4::Identity();
  F.topLeftCorner<3, 3>() = T_before_after.inverse().adjoint();
  P_.topRows<kErrors>() = (F * P_.topRows<kErrors>()).eval();
  P_.leftCols<kErrors>() = (P_.leftCols<kErrors>() * F.transpose()).eval();
  P_.topLeftCorner<kErrors, kErrors>() += covariance;
}

std::int64_t PoseFilter::addAnchor() {
  const Eigen::Index n = P_.rows();
  Eigen::MatrixXd P(n + kErrors, n + kErrors);
  P.topLeftCorner(n, n) = P_;
  P.bottomLeftCorner(kErrors, n) = P_.topRows<kErrors>();
  P.topRightCorner(n, kErrors) = P_.leftCols<kErrors>();
  P.bottomRightCorner<kErrors, kErrors>() = P_.topLeftCorner<kErrors, kErrors>();
  P_ = std::move(P);
  poses_.push_back(poses_[0]);
  ids_.push_back(next_id_);
  return next_id_++;
}

std::int64_t PoseFilter::addHeadingReference(double sigma) {
  const std::int64_t anchor = addAnchor();
  const Eigen::Index angle = P_.rows() - kErrors + 2;
  P_(angle, angle) += sigma * sigma;
  return anchor;
}

std::int64_t PoseFilter::addPlace(const GroundPose& pose, const Matrix4& covariance) {
  const Eigen::Index n = P_.rows();
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(n + kErrors, n + kErrors);
  P.topLeftCorner(n, n) = P_;
  P.bottomRightCorner<kErrors, kErrors>() = covariance;
  P_ = std::move(P);
  poses_.push_back(pose);
  ids_.push_back(next_id_);
  return next_id_++;
}

void PoseFilter::rebase(const SE2& T_new_world, double dz) {
  for (GroundPose& pose : poses_) {
    pose.T_world_vehicle = T_new_world * pose.T_world_vehicle;
    pose.z += dz;
  }
}

bool PoseFilter::hasAnchor(std::int64_t anchor) const {
  return std::binary_search(ids_.begin(), ids_.end(), anchor);
}

Eigen::Index PoseFilter::indexOf(std::int64_t anchor) const {
  if (anchor == kCar) return 0;
  const auto it = std::lower_bound(ids_.begin(), ids_.end(), anchor);
  PARKADE_CHECK(it != ids_.end() && *it == anchor, "the filter holds no anchor {}", anchor);
  return 1 + (it - ids_.begin());
}

const GroundPose& PoseFilter::anchor(std::int64_t anchor) const {
  return poses_[static_cast<std::size_t>(indexOf(anchor))];
}

void PoseFilter::removeAnchor(std::int64_t anchor) {
  const Eigen::Index gone = indexOf(anchor);
  const Eigen::Index before = gone * kErrors;
  const Eigen::Index after = P_.rows() - before - kErrors;
  Eigen::MatrixXd P(P_.rows() - kErrors, P_.cols() - kErrors);
  P.topLeftCorner(before, before) = P_.topLeftCorner(before, before);
  P.topRightCorner(before, after) = P_.topRightCorner(before, after);
  P.bottomLeftCorner(after, before) = P_.bottomLeftCorner(after, before);
  P.bottomRightCorner(after, after) = P_.bottomRightCorner(after, after);
  P_ = std::move(P);
  poses_.erase(poses_.begin() + gone);
  ids_.erase(ids_.begin() + (gone - 1));
}

// Equation (3): the error of T_a_b is e_b - Ad(T_a_b^-1) e_a.
Eigen::MatrixXd PoseFilter::relativeJacobian(Eigen::Index a, Eigen::Index b) const {
  const SE2 T_a_b = poses_[static_cast<std::size_t>(a)].T_world_vehicle.inverse() *
                    poses_[static_cast<std::size_t>(b)].T_world_vehicle;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(kErrors, P_.cols());
  H.block<kErrors, kErrors>(0, kErrors * b).setIdentity();
  H.block<3, 3>(0, kErrors * a) = -T_a_b.inverse().adjoint();
  H(3, kErrors * a + 3) = -1.0;
  return H;
}

PoseFilter::Matrix4 PoseFilter::relativeCovariance(std::int64_t anchor, std::int64_t of) const {
  const Eigen::MatrixXd H = relativeJacobian(indexOf(anchor), indexOf(of));
  return H * P_ * H.transpose();
}

void PoseFilter::apply(const Eigen::VectorXd& error) {
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const Eigen::Vector4d e = error.segment<kErrors>(kErrors * static_cast<Eigen::Index>(k));
    poses_[k].T_world_vehicle = poses_[k].T_world_vehicle * SE2::exp(e.head<3>());
    poses_[k].z += e[3];
  }
}

FilterUpdate PoseFilter::correct(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& H,
                                 const Eigen::MatrixXd& noise, double gate_probability) {
  FilterUpdate update;
  const Eigen::MatrixXd PHt = P_ * H.transpose();
  const Eigen::MatrixXd S = H * PHt + noise;
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  if (llt.info() != Eigen::Success) return update;
  update.distance = innovation.dot(llt.solve(innovation));
  update.gate = chiSquareQuantile(static_cast<int>(innovation.size()), gate_probability);
  if (!(update.distance <= update.gate)) return update;
  update.accepted = true;
  const Eigen::MatrixXd K = llt.solve(PHt.transpose()).transpose();
  apply(K * innovation);
  // Equation (4): Joseph's form, multiplied out, costs the state's size squared and not cubed.
  const Eigen::MatrixXd KHP = K * PHt.transpose();
  P_ += K * S * K.transpose() - KHP - KHP.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  return update;
}

FilterUpdate PoseFilter::relative(Eigen::Index a, Eigen::Index b, const SE2& T_a_b,
                                  const Eigen::Matrix3d& information, double gate_probability) {
  const SE2 predicted = poses_[static_cast<std::size_t>(a)].T_world_vehicle.inverse() *
                        poses_[static_cast<std::size_t>(b)].T_world_vehicle;
  const Eigen::Vector3d innovation = (predicted.inverse() * T_a_b).log();
  const Eigen::MatrixXd H = relativeJacobian(a, b).topRows<3>();
  // Only directions with information are measured.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  constexpr double kLeast = 1e-6;
  Eigen::MatrixXd U(3, 0);
  Eigen::VectorXd variance(0);
  for (int k = 0; k < 3; ++k) {
    if (eigen.eigenvalues()[k] <= kLeast) continue;
    U.conservativeResize(3, U.cols() + 1);
    U.col(U.cols() - 1) = eigen.eigenvectors().col(k);
    variance.conservativeResize(variance.size() + 1);
    variance[variance.size() - 1] = 1.0 / eigen.eigenvalues()[k];
  }
  if (U.cols() == 0) return {};
  return correct(U.transpose() * innovation, U.transpose() * H, variance.asDiagonal(),
                 gate_probability);
}

FilterUpdate PoseFilter::updateRelative(std::int64_t anchor, const SE2& T_anchor_vehicle,
                                        const Eigen::Matrix3d& information,
                                        double gate_probability) {
  return relative(indexOf(anchor), 0, T_anchor_vehicle, information, gate_probability);
}

FilterUpdate PoseFilter::updateBetween(std::int64_t a, std::int64_t b, const SE2& T_a_b,
                                       const Eigen::Matrix3d& information,
                                       double gate_probability) {
  return relative(indexOf(a), indexOf(b), T_a_b, information, gate_probability);
}

FilterUpdate PoseFilter::updateHeight(std::int64_t anchor, double dz, double sigma,
                                      double gate_probability, std::int64_t of) {
  const Eigen::Index a = indexOf(anchor);
  const Eigen::Index b = indexOf(of);
  const double predicted =
      poses_[static_cast<std::size_t>(b)].z - poses_[static_cast<std::size_t>(a)].z;
  const Eigen::MatrixXd H = relativeJacobian(a, b).bottomRows<1>();
  return correct(Eigen::VectorXd::Constant(1, dz - predicted), H,
                 Eigen::MatrixXd::Constant(1, 1, sigma * sigma), gate_probability);
}

FilterUpdate PoseFilter::updateTurn(std::int64_t anchor, double angle, double sigma,
                                    double gate_probability, std::int64_t of) {
  const Eigen::Index a = indexOf(anchor);
  const Eigen::Index b = indexOf(of);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, P_.cols());
  H(0, kErrors * b + 2) = 1.0;
  H(0, kErrors * a + 2) -= 1.0;
  const double turned = poses_[static_cast<std::size_t>(b)].T_world_vehicle.angle() -
                        poses_[static_cast<std::size_t>(a)].T_world_vehicle.angle();
  return correct(Eigen::VectorXd::Constant(1, wrapAngle(angle - turned)), H,
                 Eigen::MatrixXd::Constant(1, 1, sigma * sigma), gate_probability);
}

FilterUpdate PoseFilter::updateHeading(double angle, double sigma, double gate_probability,
                                       std::int64_t of) {
  const Eigen::Index b = indexOf(of);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(1, P_.cols());
  H(0, kErrors * b + 2) = 1.0;
  const double innovation =
      wrapAngle(angle - poses_[static_cast<std::size_t>(b)].T_world_vehicle.angle());
  return correct(Eigen::VectorXd::Constant(1, innovation), H,
                 Eigen::MatrixXd::Constant(1, 1, sigma * sigma), gate_probability);
}

}  // namespace parkade
