// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/paint_raster.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/mapping/storage/map_drawing.hpp"

namespace parkade {

using Eigen::Vector2d;
using Eigen::Vector2i;

PaintRaster::PaintRaster(const LayeredGrid& grid, SemanticClass semantic_class)
    : resolution_(grid.resolution()) {
  const auto bounds = grid.bounds(GridLayer::kRoadMarkers);
  if (!bounds) return;
  const Vector2i size = bounds->max - bounds->min + Vector2i::Ones();
  if (!checkPictureSize(size.cast<double>())) return;  // of a drive that went astray
  origin_ = bounds->min;
  cells_ = cv::Mat1b::zeros(size.y(), size.x());
  grid.forEachKnown(GridLayer::kRoadMarkers, [&](const Vector2i& index, const GridCell& cell) {
    const Vector2i i = index - origin_;
    const bool paint = cell.believed() == semantic_class;
    cells_(i.y(), i.x()) = static_cast<std::uint8_t>(paint ? Cell::kPaint : Cell::kBare);
  });
}

PaintRaster::Shares PaintRaster::sharesAt(const Vector2d& p) const {
  const Vector2d q = p.array() / resolution_ - 0.5;
  const Vector2d low = q.array().floor();
  const Vector2d part = q - low;
  const Vector2i i = low.cast<int>() - origin_;
  Shares shares;
  for (const int x : {0, 1}) {
    for (const int y : {0, 1}) {
      const double weight =
          (x == 1 ? part.x() : 1.0 - part.x()) * (y == 1 ? part.y() : 1.0 - part.y());
      const Cell cell = cellAt(i + Vector2i(x, y));
      shares.paint += cell == Cell::kPaint ? weight : 0.0;
      shares.bare += cell == Cell::kBare ? weight : 0.0;
    }
  }
  return shares;
}

Vector2d PaintRaster::middleOf(int row, int column) const {
  return resolution_ * ((origin_ + Vector2i(column, row)).cast<double>().array() + 0.5);
}

std::vector<cv::Point> PaintRaster::cornersOf(const std::vector<Vector2d>& outline) const {
  std::vector<cv::Point> corners;
  for (const Vector2d& p : outline) {
    const Vector2i cell = Vector2i((p / resolution_).array().floor().cast<int>()) - origin_;
    corners.emplace_back(cell.x(), cell.y());
  }
  return corners;
}

void PaintRaster::hide(const std::vector<Vector2d>& outline) {
  if (cells_.empty()) return;
  cv::fillConvexPoly(cells_, cornersOf(outline), cv::Scalar(static_cast<int>(Cell::kUnknown)));
}

std::vector<Vector2d> PaintRaster::paintIn(const std::vector<Vector2d>& outline) const {
  const std::vector<cv::Point> corners = cornersOf(outline);
  const cv::Rect box = cv::boundingRect(corners) & cv::Rect(0, 0, cells_.cols, cells_.rows);
  std::vector<Vector2d> paint;
  for (int row = box.y; row < box.y + box.height; ++row) {
    for (int column = box.x; column < box.x + box.width; ++column) {
      if (static_cast<Cell>(cells_(row, column)) != Cell::kPaint) continue;
      if (cv::pointPolygonTest(corners, cv::Point2f(cv::Point(column, row)), false) < 0.0) continue;
      paint.push_back(middleOf(row, column));
    }
  }
  return paint;
}

std::vector<std::vector<Vector2d>> PaintRaster::patches(double apart, std::size_t fewest) const {
  if (cells_.empty()) return {};
  const cv::Mat1b paint = cells_ == static_cast<int>(Cell::kPaint);
  const int reach = static_cast<int>(std::lround(0.5 * apart / resolution_));
  cv::Mat1b wide;
  cv::dilate(paint, wide,
             cv::getStructuringElement(cv::MORPH_RECT, {2 * reach + 1, 2 * reach + 1}));
  cv::Mat1i labels;
  std::vector<std::vector<Vector2d>> patches(
      static_cast<std::size_t>(cv::connectedComponents(wide, labels)));
  for (int row = 0; row < paint.rows; ++row) {
    for (int column = 0; column < paint.cols; ++column) {
      if (paint(row, column) == 0) continue;
      patches[static_cast<std::size_t>(labels(row, column))].push_back(middleOf(row, column));
    }
  }
  std::erase_if(patches, [fewest](const auto& patch) { return patch.size() < fewest; });
  return patches;
}

std::int64_t nextObjectId(const ParkingMap& map) {
  std::int64_t next = 1;
  for (const MapObject& object : map.objects) next = std::max(next, object.id + 1);
  return next;
}

}  // namespace parkade
