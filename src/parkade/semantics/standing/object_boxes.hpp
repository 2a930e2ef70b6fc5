// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace parkade {

/// A rectangle on the ground.
struct GroundBox {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double heading = 0.0;                            ///< rad, of its x axis
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< m along x and y

  [[nodiscard]] Eigen::Matrix2d axes() const;
  [[nodiscard]] std::vector<Eigen::Vector2d> outline() const;  ///< counter-clockwise
  [[nodiscard]] bool contains(const Eigen::Vector2d& p, double margin) const;
  [[nodiscard]] Eigen::Vector2d nearestTo(const Eigen::Vector2d& p) const;  ///< of its outline
};

/// The rectangle whose one or two faces towards the viewer lie along the points, in as far as the
/// points reach: X. Zhang et al., "Efficient L-shape fitting for vehicle detection using laser
/// scanners", IV 2017, with the mean distance to the nearest face as the criterion. Headings are in
/// [0, pi / 2). Points of its far side are not known; the caller completes it. off, if given: that
/// mean distance, m, no point counting more than 0.2. heading, rad: that of one of its axes, where
/// it is known.
GroundBox fitFaces(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& viewer,
                   double* off = nullptr, std::optional<double> heading = std::nullopt);

/// Grows a box to at least these sizes along its axes, away from the viewer.
GroundBox grownTo(const GroundBox& box, const Eigen::Vector2d& size, const Eigen::Vector2d& viewer);

}  // namespace parkade
