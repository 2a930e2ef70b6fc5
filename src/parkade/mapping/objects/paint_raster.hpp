// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/mapping/parking_map.hpp"

// Inside of painted_arrows.hpp, painted_crossings.hpp and slots/reserved_slots.hpp.

namespace parkade {

/// What the layer of road markers holds of the paint of one class, over the box of all that it
/// knows. World frame. Empty where that box is too large for a picture: of a drive that went
/// astray.
class PaintRaster {
 public:
  enum class Cell : std::uint8_t { kUnknown, kBare, kPaint };  ///< bare: anything but that paint

  PaintRaster(const LayeredGrid& grid, SemanticClass semantic_class);

  [[nodiscard]] Cell at(const Eigen::Vector2d& p) const {
    return cellAt(Eigen::Vector2i((p / resolution_).array().floor().cast<int>()) - origin_);
  }
  /// Of paint and of what is bare around a place, between the four nearest cells.
  struct Shares {
    double paint = 0.0;
    double bare = 0.0;
  };
  [[nodiscard]] Shares sharesAt(const Eigen::Vector2d& p) const;
  [[nodiscard]] double resolution() const { return resolution_; }

  /// Makes what lies inside a convex outline unknown.
  void hide(const std::vector<Eigen::Vector2d>& outline);
  /// Middles of the cells of paint inside a convex outline.
  [[nodiscard]] std::vector<Eigen::Vector2d> paintIn(
      const std::vector<Eigen::Vector2d>& outline) const;
  /// The cells of paint, by their middles, in patches that lie farther from each other than apart,
  /// m (0: that do not touch); without those of fewer cells.
  [[nodiscard]] std::vector<std::vector<Eigen::Vector2d>> patches(double apart,
                                                                  std::size_t fewest) const;

 private:
  [[nodiscard]] Cell cellAt(const Eigen::Vector2i& i) const {
    if (i.x() < 0 || i.y() < 0 || i.x() >= cells_.cols || i.y() >= cells_.rows) {
      return Cell::kUnknown;
    }
    return static_cast<Cell>(cells_(i.y(), i.x()));
  }
  [[nodiscard]] std::vector<cv::Point> cornersOf(const std::vector<Eigen::Vector2d>& outline) const;
  [[nodiscard]] Eigen::Vector2d middleOf(int row, int column) const;

  double resolution_;
  Eigen::Vector2i origin_ = Eigen::Vector2i::Zero();
  cv::Mat1b cells_;  // rows along y
};

/// Cells of the layer of road markers that are taken for floor and lie, by their middles, in a
/// shape become paint of a class. outline: bounds the shape; holds(p): whether it holds a place.
template <class Holds>
void drawPaint(SemanticClass semantic_class, const std::vector<Eigen::Vector2d>& outline,
               const Holds& holds, LayeredGrid& grid) {
  constexpr float kLogOdds = 1.0F;  // against what was seen there
  Eigen::Vector2d low = outline.front();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& p : outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2i first = grid.cellOf(low);
  const Eigen::Vector2i last = grid.cellOf(high);
  for (int x = first.x(); x <= last.x(); ++x) {
    for (int y = first.y(); y <= last.y(); ++y) {
      const Eigen::Vector2i cell(x, y);
      if (grid.at(GridLayer::kRoadMarkers, cell).believed() != SemanticClass::kFloor) continue;
      if (!holds(grid.centerOf(cell))) continue;
      grid.set(GridLayer::kRoadMarkers, cell, semantic_class, kLogOdds);
    }
  }
}

/// One that no object of the map has.
std::int64_t nextObjectId(const ParkingMap& map);

}  // namespace parkade
