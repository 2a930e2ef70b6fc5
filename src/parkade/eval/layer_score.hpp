// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/eval/map_truth.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/layered_grid.hpp"

namespace parkade {

/// How the cells of one layer agree with the truth, over the cells that the layer knows.
struct LayerScore {
  std::int64_t present = 0;  ///< cells where the map has something
  std::int64_t truth = 0;    ///< cells where there is something
  std::int64_t both = 0;
  double iou = 0.0;
  double tolerant_precision = 0.0;  ///< present cells with one of the truth within one cell
  double tolerant_recall = 0.0;     ///< cells of the truth with a present one within one cell
  double tolerant_iou = 0.0;        ///< 1 / (1 / precision + 1 / recall - 1)
  /// Share of the truth's cells near the way that the layer knows, also of those beyond its cells.
  double seen = 0.0;
};

/// One layer as pictures over the same box of cells, row 0 at the lowest y. Truth and map in the
/// map's frame.
struct LayerRaster {
  Eigen::Vector2i origin = Eigen::Vector2i::Zero();  ///< cell of column 0, row 0
  cv::Mat known;                                     ///< CV_8UC1, 0 or 1, as the others
  cv::Mat present;
  cv::Mat truth;
};

/// Fills the box of all known cells of the layer. Layers 1, 3 and 4 hold areas of their classes;
/// layer 2 is judged in the middle of slots only (the middle half of each side), where occupied
/// ones must show a vehicle. Nothing (empty pictures) for layer 5, and where no cell is known.
/// Fails where cells lie too far apart for a picture (checkPictureSize()).
Result<LayerRaster> rasteriseLayer(const LayeredGrid& grid, GridLayer layer, const SE2& T_truth_map,
                                   const MapTruth& truth);

/// Whether a cell or one of its eight neighbours is not 0 in a CV_8UC1 picture.
bool anyNear(const cv::Mat& picture, int row, int column);

/// Scores a layer; the way, in the map's frame, says which truth is near. Fails as
/// rasteriseLayer() does, or where the way is as wide.
Result<LayerScore> scoreLayer(const LayeredGrid& grid, GridLayer layer, const SE2& T_truth_map,
                              const MapTruth& truth, const std::vector<Eigen::Vector2d>& way,
                              double near_m);

}  // namespace parkade
