// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/standing_foot.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace parkade {
namespace {

struct Line {
  Eigen::Vector2d middle;
  Eigen::Vector2d normal;
};

// Through most of the points; those more than a pixel off (the ends' sides) are left out in the
// end.
Line fitLine(const std::vector<Eigen::Vector2d>& points, double pixel) {
  Line line{points.front(), Eigen::Vector2d::UnitX()};
  for (const double reach : {std::numeric_limits<double>::infinity(), 3.0 * pixel, pixel}) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    double count = 0.0;
    for (const Eigen::Vector2d& p : points) {
      if (std::isfinite(reach) && std::abs(line.normal.dot(p - line.middle)) > reach) continue;
      mean += p;
      square += p * p.transpose();
      count += 1.0;
    }
    if (count < 3.0) break;
    mean /= count;
    const Eigen::Matrix2d spread = square / count - mean * mean.transpose();
    line = {mean, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(0)};
  }
  return line;
}

}  // namespace

MarkingPiece footOf(const MarkingPiece& piece, const BevViews& views, const BevGeometry& geometry,
                    double depth) {
  struct Polar {
    std::pair<std::size_t, int> ray;  // view, direction
    double range;
  };
  double least = std::numeric_limits<double>::max();
  for (const Eigen::Vector2d& p : piece.points) {
    least = std::min(least, (p - views.viewAt(geometry, p).foot).norm());
  }
  // As wide as a pixel and a half where it is nearest: no direction goes without its first pixel.
  const double step = 1.5 * geometry.metres_per_px / std::max(least, 0.5);
  std::vector<Polar> polar;
  std::map<std::pair<std::size_t, int>, double> nearest;
  for (const Eigen::Vector2d& p : piece.points) {
    const BevViews::View& view = views.viewAt(geometry, p);
    const Eigen::Vector2d d = p - view.foot;
    const auto index = static_cast<std::size_t>(&view - views.views.data());
    const Polar at{{index, static_cast<int>(std::lround(std::atan2(d.y(), d.x()) / step))},
                   d.norm()};
    const auto [entry, fresh] = nearest.try_emplace(at.ray, at.range);
    if (!fresh) entry->second = std::min(entry->second, at.range);
    polar.push_back(at);
  }
  std::vector<Eigen::Vector2d> edge;
  for (std::size_t i = 0; i < polar.size(); ++i) {
    if (polar[i].range <= nearest.at(polar[i].ray)) edge.push_back(piece.points[i]);
  }
  // The far side of a low thing runs along the near one.
  const Line near = fitLine(edge, geometry.metres_per_px);
  Eigen::Vector2d away = near.normal;
  if (away.dot(near.middle - views.viewAt(geometry, near.middle).foot) < 0.0) away = -away;
  MarkingPiece foot = piece;
  foot.points.clear();
  foot.at_edge.clear();
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < polar.size(); ++i) {
    if (away.dot(piece.points[i] - near.middle) > depth) continue;
    foot.points.push_back(piece.points[i]);
    foot.at_edge.push_back(piece.at_edge[i]);
    hidden += piece.at_edge[i] ? 1 : 0;
  }
  // Beside and behind stand walls and cars; a picture's end or a car before it hides more.
  foot.cut = 4 * hidden > foot.points.size();
  return foot;
}

}  // namespace parkade
