// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/object_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/core/check.hpp"

namespace parkade {

Eigen::Matrix2d GroundBox::axes() const {
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  Eigen::Matrix2d R;
  R << c, -s, s, c;
  return R;
}

std::vector<Eigen::Vector2d> GroundBox::outline() const {
  const Eigen::Matrix2d R = axes();
  std::vector<Eigen::Vector2d> corners;
  for (const auto& corner : {Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(0.5, -0.5),
                             Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(-0.5, 0.5)}) {
    corners.emplace_back(center + R * corner.cwiseProduct(size));
  }
  return corners;
}

bool GroundBox::contains(const Eigen::Vector2d& p, double margin) const {
  const Eigen::Vector2d d = axes().transpose() * (p - center);
  return (d.cwiseAbs() - 0.5 * size).maxCoeff() <= margin;
}

Eigen::Vector2d GroundBox::nearestTo(const Eigen::Vector2d& p) const {
  const Eigen::Matrix2d R = axes();
  const Eigen::Vector2d d = R.transpose() * (p - center);
  return center + R * d.cwiseMin(0.5 * size).cwiseMax(-0.5 * size);
}

GroundBox fitFaces(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& viewer,
                   double* off, std::optional<double> heading) {
  PARKADE_CHECK(!points.empty(), "no points");
  constexpr int kHeadings = 45;
  constexpr double kFar = 0.2;  // m: points inside, as of a wheel house, say nothing of a face
  GroundBox best;
  double least = std::numeric_limits<double>::max();
  const std::size_t stride = std::max<std::size_t>(1, points.size() / 80);
  for (int k = 0; k < (heading ? 1 : kHeadings); ++k) {
    GroundBox box;
    box.heading =
        heading ? *heading - M_PI_2 * std::floor(*heading / M_PI_2) : k * M_PI_2 / kHeadings;
    const Eigen::Matrix2d R = box.axes().transpose();
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
    Eigen::Vector2d high = -low;
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d q = R * p;
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
    const Eigen::Vector2d seen_from = R * viewer;
    const Eigen::Vector2d middle = 0.5 * (low + high);
    const Eigen::Vector2d near((seen_from.x() < middle.x() ? low : high).x(),
                               (seen_from.y() < middle.y() ? low : high).y());
    double cost = 0.0;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      cost += std::min(kFar, (R * points[i] - near).cwiseAbs().minCoeff());
    }
    if (cost >= least) continue;
    least = cost;
    box.center = R.transpose() * middle;
    box.size = high - low;
    best = box;
  }
  if (off != nullptr) *off = least / static_cast<double>((points.size() + stride - 1) / stride);
  return best;
}

GroundBox grownTo(const GroundBox& box, const Eigen::Vector2d& size,
                  const Eigen::Vector2d& viewer) {
  GroundBox grown = box;
  const Eigen::Matrix2d R = box.axes();
  const Eigen::Vector2d away = R.transpose() * (box.center - viewer);
  for (int i = 0; i < 2; ++i) {
    const double more = size[i] - box.size[i];
    if (more <= 0.0) continue;
    grown.size[i] = size[i];
    grown.center += R.col(i) * (away[i] >= 0.0 ? 0.5 : -0.5) * more;
  }
  return grown;
}

}  // namespace parkade
