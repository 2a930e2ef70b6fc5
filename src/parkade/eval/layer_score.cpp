// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/layer_score.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/mapping/frame_evidence.hpp"
#include "parkade/mapping/storage/map_drawing.hpp"

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

// The pictures of a box of cells, all 0.
Result<cv::Mat> emptyPicture(GridLayer layer, const LayeredGrid::Bounds& box) {
  const Eigen::Vector2d size =
      box.max.cast<double>() - box.min.cast<double>() + Eigen::Vector2d::Ones();
  if (const Status fits = checkPictureSize(size); !fits) {
    return Error{fmt::format(
        "the layer {} cannot be judged: {}; see with 'parkade map check' what lies too far away",
        kGridLayerNames[static_cast<std::size_t>(layer)], fits.error().message)};
  }
  return cv::Mat(cv::Mat::zeros(static_cast<int>(size.y()), static_cast<int>(size.x()), CV_8UC1));
}

// Fills what the layer should show into `real`; and, of layer 2, where that is judged at all.
void fillTruth(GridLayer layer, const MapTruth& truth, const SE2& T_map_truth, double resolution,
               const Eigen::Vector2i& origin, cv::Mat& real, cv::Mat& judged) {
  const auto toMap = [&](Polygon polygon) {
    for (Eigen::Vector2d& p : polygon) p = T_map_truth * p;
    return polygon;
  };
  if (layer == GridLayer::kAvailability) {
    judged = cv::Mat::zeros(real.size(), CV_8UC1);
    for (const TruthSlot& slot : truth.slots) {
      const Polygon middle = toMap(middleOf(slot));
      fill(middle, resolution, origin, 1, judged);
      if (slot.occupied) fill(middle, resolution, origin, 1, real);
    }
    return;
  }
  for (const TruthArea& area : truth.areas) {
    if (!belongs(layer, area.semantic_class)) continue;
    fill(toMap(area.outline), resolution, origin, 1, real);
  }
}

double shareOf(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

// Fills discs along the way, no closer than half a metre: the edge of the region is not telling.
void fillNear(const std::vector<Eigen::Vector2d>& way, double near_m, double resolution,
              const Eigen::Vector2i& origin, cv::Mat& near) {
  Eigen::Vector2d last = Eigen::Vector2d::Constant(1e12);
  for (const Eigen::Vector2d& p : way) {
    if ((p - last).norm() < 0.5) continue;
    last = p;
    Polygon disc;
    for (int k = 0; k < 32; ++k) {
      const double angle = 2.0 * M_PI * k / 32.0;
      disc.push_back(p + near_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    fill(disc, resolution, origin, 1, near);
  }
}

// Share of the truth's cells near the way that the layer knows, wherever its own cells end.
Result<double> shareSeen(const LayeredGrid& grid, GridLayer layer, const SE2& T_truth_map,
                         const MapTruth& truth, const std::vector<Eigen::Vector2d>& way,
                         double near_m) {
  if (way.empty()) return 0.0;
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(near_m);
  LayeredGrid::Bounds box{grid.cellOf(way.front()), grid.cellOf(way.front())};
  for (const Eigen::Vector2d& p : way) {
    box.min = box.min.cwiseMin(grid.cellOf(p - reach));
    box.max = box.max.cwiseMax(grid.cellOf(p + reach));
  }
  Result<cv::Mat> real = emptyPicture(layer, box);
  if (!real) return real.error();
  cv::Mat near = real->clone();
  cv::Mat judged;
  fillTruth(layer, truth, T_truth_map.inverse(), grid.resolution(), box.min, *real, judged);
  fillNear(way, near_m, grid.resolution(), box.min, near);
  std::int64_t near_truth = 0;
  std::int64_t near_known = 0;
  for (int row = 0; row < near.rows; ++row) {
    for (int column = 0; column < near.cols; ++column) {
      if (real->at<std::uint8_t>(row, column) == 0 || near.at<std::uint8_t>(row, column) == 0) {
        continue;
      }
      ++near_truth;
      near_known += grid.at(layer, box.min + Eigen::Vector2i(column, row)).known() ? 1 : 0;
    }
  }
  return shareOf(near_known, near_truth);
}

LayerScore scoreAgreement(const LayerRaster& raster) {
  LayerScore score;
  std::int64_t precise = 0;
  std::int64_t recalled = 0;
  for (int row = 0; row < raster.known.rows; ++row) {
    for (int column = 0; column < raster.known.cols; ++column) {
      if (raster.known.at<std::uint8_t>(row, column) == 0) continue;
      const bool truth = raster.truth.at<std::uint8_t>(row, column) != 0;
      const bool present = raster.present.at<std::uint8_t>(row, column) != 0;
      score.truth += truth ? 1 : 0;
      score.present += present ? 1 : 0;
      score.both += truth && present ? 1 : 0;
      if (present && anyNear(raster.truth, row, column)) ++precise;
      if (truth && anyNear(raster.present, row, column)) ++recalled;
    }
  }
  score.iou = shareOf(score.both, score.truth + score.present - score.both);
  score.tolerant_precision = shareOf(precise, score.present);
  score.tolerant_recall = shareOf(recalled, score.truth);
  if (precise > 0 && recalled > 0) {
    score.tolerant_iou = 1.0 / (1.0 / score.tolerant_precision + 1.0 / score.tolerant_recall - 1.0);
  }
  return score;
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

Result<LayerRaster> rasteriseLayer(const LayeredGrid& grid, GridLayer layer, const SE2& T_truth_map,
                                   const MapTruth& truth) {
  LayerRaster raster;
  const auto bounds = grid.bounds(layer);
  if (!bounds || layer == GridLayer::kDynamic) return raster;
  raster.origin = bounds->min;
  Result<cv::Mat> empty = emptyPicture(layer, *bounds);
  if (!empty) return empty.error();
  raster.known = std::move(empty).value();
  raster.present = raster.known.clone();
  raster.truth = raster.known.clone();
  cv::Mat judged;
  fillTruth(layer, truth, T_truth_map.inverse(), grid.resolution(), raster.origin, raster.truth,
            judged);
  grid.forEachKnown(layer, [&](const Eigen::Vector2i& index, const GridCell& cell) {
    const Eigen::Vector2i place = index - raster.origin;
    const int column = place.x();
    const int row = place.y();
    if (!judged.empty() && judged.at<std::uint8_t>(row, column) == 0) return;
    raster.known.at<std::uint8_t>(row, column) = 1;
    if (cell.log_odds > 0 && cell.semantic_class != SemanticClass::kFloor) {
      raster.present.at<std::uint8_t>(row, column) = 1;
    }
  });
  return raster;
}

Result<LayerScore> scoreLayer(const LayeredGrid& grid, GridLayer layer, const SE2& T_truth_map,
                              const MapTruth& truth, const std::vector<Eigen::Vector2d>& way,
                              double near_m) {
  const Result<LayerRaster> raster = rasteriseLayer(grid, layer, T_truth_map, truth);
  if (!raster) return raster.error();
  const Result<double> seen = shareSeen(grid, layer, T_truth_map, truth, way, near_m);
  if (!seen) return seen.error();
  LayerScore score = scoreAgreement(*raster);
  score.seen = *seen;
  return score;
}

}  // namespace parkade
