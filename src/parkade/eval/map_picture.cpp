// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/map_picture.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace parkade {
namespace {

using Colour = cv::Vec3b;  // BGR

const Colour kWhite(255, 255, 255);
const Colour kSeen(244, 244, 244);
const Colour kAgreed(120, 120, 120);
const Colour kOnlyMap(60, 60, 230);
const Colour kOnlyTruth(230, 120, 40);
const Colour kFound(80, 170, 60);
const Colour kMissed(0, 130, 255);
const Colour kWrong(220, 0, 220);
const Colour kError(0, 0, 140);
const Colour kWay(240, 200, 150);

class Canvas {
 public:
  Canvas(const LayeredGrid& grid, const LayeredGrid::Bounds& bounds, int margin)
      : resolution_(grid.resolution()), low_(bounds.min - Eigen::Vector2i::Constant(margin)) {
    const Eigen::Vector2i size =
        bounds.max - bounds.min + Eigen::Vector2i::Constant(2 * margin + 1);
    picture.create(size.y(), size.x(), CV_8UC3);
    picture.setTo(cv::Scalar(kWhite[0], kWhite[1], kWhite[2]));
  }

  void cell(const Eigen::Vector2i& at, const Colour& colour) { put(at - low_, colour); }

  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Colour& colour, int width) {
    const Eigen::Vector2d from = a / resolution_ - low_.cast<double>();
    const Eigen::Vector2d to = b / resolution_ - low_.cast<double>();
    const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * (to - from).norm())));
    const int half = width / 2;
    for (int k = 0; k <= steps; ++k) {
      const Eigen::Vector2i at =
          (from + (to - from) * k / steps).array().floor().cast<int>().matrix();
      for (int dy = -half; dy <= half; ++dy) {
        for (int dx = -half; dx <= half; ++dx) put(at + Eigen::Vector2i(dx, dy), colour);
      }
    }
  }

  template <class Corners>
  void outline(const Corners& corners, const SE2& T, const Colour& colour, int width) {
    for (std::size_t k = 0; k < 4; ++k) {
      line(T * corners[k], T * corners[(k + 1) % 4], colour, width);
    }
  }

  cv::Mat picture;

 private:
  void put(const Eigen::Vector2i& at, const Colour& colour) {
    if (at.x() < 0 || at.y() < 0 || at.x() >= picture.cols || at.y() >= picture.rows) return;
    picture.at<Colour>(picture.rows - 1 - at.y(), at.x()) = colour;
  }
  double resolution_;
  Eigen::Vector2i low_;
};

void drawLayer(const LayerRaster& raster, bool ground, Canvas& canvas) {
  for (int row = 0; row < raster.known.rows; ++row) {
    for (int column = 0; column < raster.known.cols; ++column) {
      if (raster.known.at<std::uint8_t>(row, column) == 0) continue;
      const Eigen::Vector2i at = raster.origin + Eigen::Vector2i(column, row);
      const bool truth = raster.truth.at<std::uint8_t>(row, column) != 0;
      const bool present = raster.present.at<std::uint8_t>(row, column) != 0;
      if (present) {
        canvas.cell(at, anyNear(raster.truth, row, column) ? kAgreed : kOnlyMap);
      } else if (truth) {
        canvas.cell(at, anyNear(raster.present, row, column) ? kAgreed : kOnlyTruth);
      } else if (ground) {
        canvas.cell(at, kSeen);
      }
    }
  }
}

}  // namespace

Result<cv::Mat> drawMapErrors(const ParkingMap& map, const MapTruth& truth,
                              const MapEvaluation& evaluation) {
  const auto bounds = map.grid.bounds();
  if (!bounds) return Error{"the map is empty: there is nothing to draw"};
  constexpr int kMargin = 20;
  constexpr std::int64_t kWidest = 20'000;
  const std::int64_t widest =
      (bounds->max.cast<std::int64_t>() - bounds->min.cast<std::int64_t>()).maxCoeff();
  if (widest > kWidest) {
    return Error{
        fmt::format("the map is {} cells wide; at most {} fit a picture", widest, kWidest)};
  }
  Canvas canvas(map.grid, *bounds, kMargin);
  const SE2 T_map_truth = evaluation.T_truth_map.inverse();
  for (const GridLayer layer : {GridLayer::kParkingLines, GridLayer::kRoadMarkers}) {
    const Result<LayerRaster> raster =
        rasteriseLayer(map.grid, layer, evaluation.T_truth_map, truth);
    if (!raster) return raster.error();
    drawLayer(*raster, layer == GridLayer::kParkingLines, canvas);
  }
  for (std::size_t i = 1; i < truth.driven.size(); ++i) {
    const auto at = [&](std::size_t k) -> Eigen::Vector2d {
      return T_map_truth * Eigen::Vector2d(truth.driven[k].T_world_body.translation().head<2>());
    };
    canvas.line(at(i - 1), at(i), kWay, 3);
  }
  const std::set<std::size_t> missed(evaluation.missed.begin(), evaluation.missed.end());
  for (const std::size_t j : missed) {
    canvas.outline(truth.slots[j].corners, T_map_truth, kMissed, 5);
  }
  for (const SlotMatch& match : evaluation.matches) {
    canvas.outline(truth.slots[match.truth_slot].corners, T_map_truth, kFound, 1);
  }
  for (const std::size_t i : evaluation.wrong) {
    canvas.outline(map.slots[i].corners, SE2(), kWrong, 5);
  }
  for (const SlotMatch& match : evaluation.matches) {
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Vector2d real = T_map_truth * truth.slots[match.truth_slot].corners[k];
      constexpr double kBlowUp = 10.0;
      canvas.line(real, real + kBlowUp * (map.slots[match.map_slot].corners[k] - real), kError, 3);
    }
  }
  return canvas.picture;
}

}  // namespace parkade
