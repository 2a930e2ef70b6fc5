// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/coverage.hpp"

#include <algorithm>
#include <cmath>

namespace parkade::sim {
namespace {

// Adds the part of an edge that lies within one row: to each cell that it crosses the area on its
// right within that cell, and the rest of its height to the next one; sums along the row then give
// the covered areas.
void addRowPiece(std::vector<float>& row, double x0, double x1, double dy) {
  if (x0 > x1) std::swap(x0, x1);
  const double width = x1 - x0;
  const int first = static_cast<int>(std::floor(x0));
  const int last = static_cast<int>(std::floor(x1));
  if (first == last || width < 1e-12) {
    const double right = 1.0 - (0.5 * (x0 + x1) - first);  // mean share right of the edge
    row[static_cast<std::size_t>(first)] += static_cast<float>(dy * right);
    row[static_cast<std::size_t>(first) + 1] += static_cast<float>(dy * (1.0 - right));
    return;
  }
  for (int cell = first; cell <= last; ++cell) {
    const double a = std::max(x0, static_cast<double>(cell));
    const double b = std::min(x1, static_cast<double>(cell) + 1.0);
    if (b <= a) continue;
    const double piece = dy * (b - a) / width;
    const double right = 1.0 - (0.5 * (a + b) - cell);
    row[static_cast<std::size_t>(cell)] += static_cast<float>(piece * right);
    row[static_cast<std::size_t>(cell) + 1] += static_cast<float>(piece * (1.0 - right));
  }
}

}  // namespace

Coverage coverageOf(const std::vector<Eigen::Vector2d>& polygon) {
  Coverage coverage;
  if (polygon.size() < 3) return coverage;
  Eigen::Vector2d low = polygon.front();
  Eigen::Vector2d high = polygon.front();
  for (const Eigen::Vector2d& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  coverage.x0 = static_cast<int>(std::floor(low.x()));
  coverage.y0 = static_cast<int>(std::floor(low.y()));
  coverage.width = static_cast<int>(std::floor(high.x())) - coverage.x0 + 1;
  coverage.height = static_cast<int>(std::floor(high.y())) - coverage.y0 + 1;
  const auto width = static_cast<std::size_t>(coverage.width);
  std::vector<std::vector<float>> rows(static_cast<std::size_t>(coverage.height),
                                       std::vector<float>(width + 2, 0.0F));
  const Eigen::Vector2d origin(coverage.x0, coverage.y0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    Eigen::Vector2d a = polygon[i] - origin;
    Eigen::Vector2d b = polygon[(i + 1) % polygon.size()] - origin;
    if (a.y() == b.y()) continue;
    const double sign = a.y() < b.y() ? 1.0 : -1.0;
    if (sign < 0.0) std::swap(a, b);
    const double slope = (b.x() - a.x()) / (b.y() - a.y());
    for (int y = static_cast<int>(std::floor(a.y())); y < coverage.height && y < b.y(); ++y) {
      const double y0 = std::max(a.y(), static_cast<double>(y));
      const double y1 = std::min(b.y(), static_cast<double>(y) + 1.0);
      if (y1 <= y0) continue;
      addRowPiece(rows[static_cast<std::size_t>(y)], a.x() + slope * (y0 - a.y()),
                  a.x() + slope * (y1 - a.y()), sign * (y1 - y0));
    }
  }
  coverage.share.reserve(width * rows.size());
  for (const std::vector<float>& row : rows) {
    float sum = 0.0F;
    for (std::size_t x = 0; x < width; ++x) {
      sum += row[x];
      coverage.share.push_back(std::min(1.0F, std::abs(sum)));
    }
  }
  return coverage;
}

}  // namespace parkade::sim
