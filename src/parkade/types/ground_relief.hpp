// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace parkade {

/// How far the floor lies above (+) the plane that a GroundAttitude describes, m: floors have falls
/// and ramps, and no plane fits them. On a square lattice of the levelled vehicle frame, bilinear
/// between its nodes; beyond it as at its edge.
struct GroundRelief {
  Eigen::Vector2d first = Eigen::Vector2d::Zero();  ///< m, the place of node (0, 0)
  double step_m = 1.0;
  Eigen::MatrixXd heights;  ///< m, rows along x, columns along y; no nodes: a plane

  /// half nodes to either side of the frame's origin; heightAt: of a place (x, y), m.
  template <typename HeightAt>
  static GroundRelief around(int half, double step_m, HeightAt&& heightAt) {
    GroundRelief relief;
    relief.step_m = step_m;
    relief.first.setConstant(-half * step_m);
    relief.heights.resize(2 * half + 1, 2 * half + 1);
    for (int i = -half; i <= half; ++i) {
      for (int j = -half; j <= half; ++j) {
        relief.heights(i + half, j + half) = heightAt(Eigen::Vector2d(i * step_m, j * step_m));
      }
    }
    return relief;
  }

  [[nodiscard]] bool isFlat() const { return heights.size() == 0; }

  [[nodiscard]] double at(const Eigen::Vector2d& p) const {
    if (isFlat()) return 0.0;
    const auto split = [&](double place, Eigen::Index nodes, double& rest) {
      const double at = std::clamp(place / step_m, 0.0, static_cast<double>(nodes - 1));
      const Eigen::Index i =
          std::min(static_cast<Eigen::Index>(at), std::max<Eigen::Index>(0, nodes - 2));
      rest = at - static_cast<double>(i);
      return i;
    };
    double a = 0.0;
    double b = 0.0;
    const Eigen::Index i = split(p.x() - first.x(), heights.rows(), a);
    const Eigen::Index j = split(p.y() - first.y(), heights.cols(), b);
    const Eigen::Index i1 = std::min(i + 1, heights.rows() - 1);
    const Eigen::Index j1 = std::min(j + 1, heights.cols() - 1);
    return (1.0 - a) * ((1.0 - b) * heights(i, j) + b * heights(i, j1)) +
           a * ((1.0 - b) * heights(i1, j) + b * heights(i1, j1));
  }
};

}  // namespace parkade
