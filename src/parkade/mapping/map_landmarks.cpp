// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/map_landmarks.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "parkade/mapping/frame_evidence.hpp"

namespace parkade {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector2i;

// The direction of the paint of one class around a cell, and the middle across it. Nothing at
// corners and crossings, and in patches without a direction.
std::optional<LinePoint> lineAt(const LayeredGrid& grid, GridLayer layer, const Vector2i& cell,
                                SemanticClass semantic_class) {
  constexpr double kReach = 0.3;  // m
  const int reach = static_cast<int>(std::lround(kReach / grid.resolution()));
  Vector2d mean = Vector2d::Zero();
  Matrix2d squares = Matrix2d::Zero();
  int count = 0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const Vector2i at = cell + Vector2i(x, y);
      if (grid.at(layer, at).believed() != semantic_class) continue;
      const Vector2d p = grid.centerOf(at);
      mean += p;
      squares += p * p.transpose();
      ++count;
    }
  }
  const int least = std::min(8, 2 * reach);  // of a line one cell wide, with gaps
  if (count < least) return std::nullopt;
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Matrix2d> eigen(squares / count - mean * mean.transpose());
  // A line through the whole neighbourhood has standard deviations of 0.17 m along and of a third
  // of its width or less across.
  constexpr double kLeastAlong = 0.13;  // m
  const double most_across = std::max(0.06, 0.55 * grid.resolution());
  if (eigen.eigenvalues()[1] < kLeastAlong * kLeastAlong ||
      eigen.eigenvalues()[0] > most_across * most_across) {
    return std::nullopt;
  }
  LinePoint point;
  point.normal = eigen.eigenvectors().col(0);
  const Vector2d p = grid.centerOf(cell);
  point.p_level = p - point.normal * point.normal.dot(p - mean);
  point.semantic_class = semantic_class;
  constexpr double kSigma = 0.012;  // m, of cells of 0.05 m averaged along 0.6 m
  point.sigma = std::max(kSigma, 0.2 * grid.resolution());
  return point;
}

void addLines(const LayeredGrid& grid, GridLayer layer, Submap& landmarks) {
  grid.forEachKnown(layer, [&](const Vector2i& cell, const GridCell& known) {
    const SemanticClass c = known.believed();
    if (roleOf(c) != LayerRole::kLine && c != SemanticClass::kStopLine) return;
    if (const auto point = lineAt(grid, layer, cell, c)) landmarks.addLine(*point);
  });
}

}  // namespace

Submap landmarksOf(const ParkingMap& map) {
  Submap landmarks;
  addLines(map.grid, GridLayer::kParkingLines, landmarks);
  addLines(map.grid, GridLayer::kRoadMarkers, landmarks);
  const auto variance = [](double sigma) {
    constexpr double kLeastSigma = 0.02;  // m
    const double told = std::max(kLeastSigma, sigma);
    return Matrix2d(told * told * Matrix2d::Identity());
  };
  for (const MapSlot& slot : map.slots) {
    for (int i = 0; i < 2; ++i) {
      landmarks.addPoint({slot.corners[static_cast<std::size_t>(i)], variance(slot.corner_sigma),
                          SemanticClass::kSlotLine, "", 1});
    }
  }
  for (const MapObject& object : map.objects) {
    if (!isPointLandmark(object.semantic_class)) continue;
    landmarks.addPoint({object.position.head<2>(), variance(object.position_sigma),
                        object.semantic_class, object.text, 1});
  }
  return landmarks;
}

}  // namespace parkade
