// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/layer_score.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/mapping/frame_evidence.hpp"

namespace parkade {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

bool belongs(GridLayer layer, SemanticClass semantic_class) {
  switch (roleOf(semantic_class)) {
    case LayerRole::kLine:
      return layer == GridLayer::kParkingLines;
    case LayerRole::kRoadMarker:
      return layer == GridLayer::kRoadMarkers;
    case LayerRole::kStructure:
      return layer == GridLayer::kZoneMarkers;
    default:
      return false;
  }
}

// Sets every cell whose middle lies inside the polygon (even-odd rule), row by row.
void fill(const Polygon& polygon, double resolution, const Eigen::Vector2i& origin,
          std::uint8_t value, cv::Mat& picture) {
  double low = 1e12;
  double high = -1e12;
  for (const Eigen::Vector2d& p : polygon) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  const int first = std::max(0, static_cast<int>(std::floor(low / resolution)) - origin.y());
  const int last =
      std::min(picture.rows - 1, static_cast<int>(std::floor(high / resolution)) - origin.y());
  std::vector<double> crossings;
  for (int row = first; row <= last; ++row) {
    const double y = (row + origin.y() + 0.5) * resolution;
    crossings.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d& a = polygon[i];
      const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
      if ((a.y() > y) == (b.y() > y)) continue;
      crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    std::sort(crossings.begin(), crossings.end());
    std::uint8_t* cells = picture.ptr<std::uint8_t>(row);
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const int from = static_cast<int>(std::ceil(crossings[k] / resolution - 0.5)) - origin.x();
      const int to = static_cast<int>(std::floor(crossings[k + 1] / resolution - 0.5)) - origin.x();
      for (int column = std::max(0, from); column <= std::min(picture.cols - 1, to); ++column) {
        cells[column] = value;
      }
    }
  }
}

// The middle half of a slot's width and depth: covered by any parked car, and by none beside it.
Polygon middleOf(const TruthSlot& slot) {
  const auto at = [&](double across, double along) -> Eigen::Vector2d {
    const Eigen::Vector2d entrance = slot.corners[0] + across * (slot.corners[1] - slot.corners[0]);
    const Eigen::Vector2d rear = slot.corners[3] + across * (slot.corners[2] - slot.corners[3]);
    return entrance + along * (rear - entrance);
  };
  return {at(0.25, 0.25), at(0.75, 0.25), at(0.75, 0.75), at(0.25, 0.75)};
}

}  // namespace

bool anyNear(const cv::Mat& picture, int row, int column) {
  for (int r = std::max(0, row - 1); r <= std::min(picture.rows - 1, row + 1); ++r) {
    const std::uint8_t* cells = picture.ptr<std::uint8_t>(r);
    for (int c = std::max(0, column - 1); c <= std::min(picture.cols - 1, column + 1); ++c) {
      if (cells[c] != 0) return true;
    }
  }
  return false;
}

LayerRaster rasteriseLayer(const LayeredGrid& grid, GridLayer layer, const SE2& T_truth_map,
                           const MapTruth& truth) {
  LayerRaster raster;
  const auto bounds = grid.bounds(layer);
  if (!bounds || layer == GridLayer::kDynamic) return raster;
  const double resolution = grid.resolution();
  raster.origin = bounds->min;
  const Eigen::Vector2i size = bounds->max - bounds->min + Eigen::Vector2i::Ones();
  raster.known = cv::Mat::zeros(size.y(), size.x(), CV_8UC1);
  raster.present = raster.known.clone();
  raster.truth = raster.known.clone();
  const SE2 T_map_truth = T_truth_map.inverse();
  const auto toMap = [&](Polygon polygon) {
    for (Eigen::Vector2d& p : polygon) p = T_map_truth * p;
    return polygon;
  };
  const bool availability = layer == GridLayer::kAvailability;
  cv::Mat judged;
  if (availability) {
    judged = raster.known.clone();
    for (const TruthSlot& slot : truth.slots) {
      const Polygon middle = toMap(middleOf(slot));
      fill(middle, resolution, raster.origin, 1, judged);
      if (slot.occupied) fill(middle, resolution, raster.origin, 1, raster.truth);
    }
  } else {
    for (const TruthArea& area : truth.areas) {
      if (!belongs(layer, area.semantic_class)) continue;
      fill(toMap(area.outline), resolution, raster.origin, 1, raster.truth);
    }
  }
  grid.forEachKnown(layer, [&](const Eigen::Vector2i& index, const GridCell& cell) {
    const Eigen::Vector2i place = index - raster.origin;
    const int column = place.x();
    const int row = place.y();
    if (availability && judged.at<std::uint8_t>(row, column) == 0) return;
    raster.known.at<std::uint8_t>(row, column) = 1;
    if (cell.log_odds > 0 && cell.semantic_class != SemanticClass::kFloor) {
      raster.present.at<std::uint8_t>(row, column) = 1;
    }
  });
  return raster;
}

LayerScore scoreLayer(const LayerRaster& raster, double resolution,
                      const std::vector<Eigen::Vector2d>& way, double near_m) {
  LayerScore score;
  if (raster.known.empty()) return score;
  std::int64_t precise = 0;
  std::int64_t recalled = 0;
  cv::Mat near = cv::Mat::zeros(raster.known.size(), CV_8UC1);
  // Discs along the way, no closer than half a metre: the edge of the region is not telling.
  Eigen::Vector2d last = Eigen::Vector2d::Constant(1e12);
  for (const Eigen::Vector2d& p : way) {
    if ((p - last).norm() < 0.5) continue;
    last = p;
    Polygon disc;
    for (int k = 0; k < 32; ++k) {
      const double angle = 2.0 * M_PI * k / 32.0;
      disc.push_back(p + near_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    fill(disc, resolution, raster.origin, 1, near);
  }
  std::int64_t near_truth = 0;
  std::int64_t near_known = 0;
  for (int row = 0; row < raster.known.rows; ++row) {
    for (int column = 0; column < raster.known.cols; ++column) {
      const bool known = raster.known.at<std::uint8_t>(row, column) != 0;
      const bool truth = raster.truth.at<std::uint8_t>(row, column) != 0;
      const bool present = raster.present.at<std::uint8_t>(row, column) != 0;
      if (truth && near.at<std::uint8_t>(row, column) != 0) {
        ++near_truth;
        near_known += known ? 1 : 0;
      }
      if (!known) continue;
      score.truth += truth ? 1 : 0;
      score.present += present ? 1 : 0;
      score.both += truth && present ? 1 : 0;
      if (present && anyNear(raster.truth, row, column)) ++precise;
      if (truth && anyNear(raster.present, row, column)) ++recalled;
    }
  }
  const auto share = [](std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  score.iou = share(score.both, score.truth + score.present - score.both);
  score.tolerant_precision = share(precise, score.present);
  score.tolerant_recall = share(recalled, score.truth);
  if (precise > 0 && recalled > 0) {
    score.tolerant_iou = 1.0 / (1.0 / score.tolerant_precision + 1.0 / score.tolerant_recall - 1.0);
  }
  score.seen = share(near_known, near_truth);
  return score;
}

}  // namespace parkade
