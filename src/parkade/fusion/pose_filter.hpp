// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/geometry/se2.hpp"

namespace parkade {

/// A pose over the ground: place and heading in the plane, and the height.
struct GroundPose {
  SE2 T_world_vehicle;
  double z = 0.0;  ///< m
};

/// What a correction did.
struct FilterUpdate {
  bool accepted = false;
  double distance = 0.0;  ///< squared Mahalanobis distance of the innovation
  double gate = 0.0;      ///< that it was held against
};

/// Error-state extended Kalman filter over the car's pose and past poses of it, the anchors, each
/// with four errors: (x, y, angle) as right perturbation of its SE2, and z. The one owner of the
/// covariance. Odometry predicts; a registration to a submap measures the pose relative to that
/// submap's anchor, whose error and whose correlation with the car the state holds: what a map that
/// was made from these same poses can tell, and no more. docs/math/fusion.md.
class PoseFilter {
 public:
  using Matrix4 = Eigen::Matrix4d;
  /// In the place of an anchor: the car as it is now.
  static constexpr std::int64_t kCar = -1;

  explicit PoseFilter(const GroundPose& pose = {}, const Matrix4& covariance = Matrix4::Zero());

  /// The car moved by T_before_after and dz, with that covariance (right perturbation of the
  /// motion).
  void predict(const SE2& T_before_after, double dz, const Matrix4& covariance);

  /// Keeps the present pose as an anchor.
  std::int64_t addAnchor();
  /// Keeps the present heading as an anchor of what points the same way all the time, such as a
  /// garage's axes, which was read off with an error of sigma: unlike the readings' own errors it
  /// stays the same, and the filter learns it.
  std::int64_t addHeadingReference(double sigma);
  /// A place that is known by other means than from the car, such as the origin of a saved map,
  /// with an error of its own.
  std::int64_t addPlace(const GroundPose& pose, const Matrix4& covariance);
  /// Calls the world otherwise: every pose seen from another origin, dz higher. All errors stay,
  /// for they are seen from the poses themselves.
  void rebase(const SE2& T_new_world, double dz);
  /// Forgets an anchor; the rest keeps what it learned through it.
  void removeAnchor(std::int64_t anchor);

  /// The car seen from an anchor. information is of T_anchor_vehicle (right perturbation) and may
  /// be singular: directions without information are left alone. Refused, and nothing changed,
  /// where the innovation's chi-square probability is below gate_probability.
  FilterUpdate updateRelative(std::int64_t anchor, const SE2& T_anchor_vehicle,
                              const Eigen::Matrix3d& information, double gate_probability);
  /// The same between two anchors: T_a_b.
  FilterUpdate updateBetween(std::int64_t a, std::int64_t b, const SE2& T_a_b,
                             const Eigen::Matrix3d& information, double gate_probability);
  /// The car (or another anchor) stands dz above where it stood at the anchor.
  FilterUpdate updateHeight(std::int64_t anchor, double dz, double sigma, double gate_probability,
                            std::int64_t of = kCar);
  /// The car, or another anchor, has turned by angle since the anchor.
  FilterUpdate updateTurn(std::int64_t anchor, double angle, double sigma, double gate_probability,
                          std::int64_t of = kCar);
  /// The heading in the world, of the car or of an anchor.
  FilterUpdate updateHeading(double angle, double sigma, double gate_probability,
                             std::int64_t of = kCar);

  [[nodiscard]] const GroundPose& pose() const { return poses_.front(); }
  [[nodiscard]] Matrix4 covariance() const { return P_.topLeftCorner<4, 4>(); }
  [[nodiscard]] bool hasAnchor(std::int64_t anchor) const;
  [[nodiscard]] const GroundPose& anchor(std::int64_t anchor) const;
  [[nodiscard]] const std::vector<std::int64_t>& anchors() const { return ids_; }
  /// Covariance of T_anchor_vehicle (right perturbation) and of the height between them; of: the
  /// car, or another anchor in its place.
  [[nodiscard]] Matrix4 relativeCovariance(std::int64_t anchor, std::int64_t of = kCar) const;

 private:
  [[nodiscard]] Eigen::Index indexOf(std::int64_t anchor) const;  ///< pose number; throws if gone
  /// Covariance of the pose number b seen from the pose number a, and its Jacobian.
  [[nodiscard]] Eigen::MatrixXd relativeJacobian(Eigen::Index a, Eigen::Index b) const;
  FilterUpdate relative(Eigen::Index a, Eigen::Index b, const SE2& T_a_b,
                        const Eigen::Matrix3d& information, double gate_probability);
  FilterUpdate correct(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& H,
                       const Eigen::MatrixXd& noise, double gate_probability);
  void apply(const Eigen::VectorXd& error);

  std::vector<GroundPose> poses_;  // the car, then the anchors
  std::vector<std::int64_t> ids_;  // of the anchors
  std::int64_t next_id_ = 0;
  Eigen::MatrixXd P_;
};

/// The value that a chi-square variable of that many degrees of freedom stays below with this
/// probability (Wilson and Hilferty's approximation, good to 2 % for 1 to 10 degrees).
double chiSquareQuantile(int degrees, double probability);

}  // namespace parkade
