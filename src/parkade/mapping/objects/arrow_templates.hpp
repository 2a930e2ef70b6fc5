// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <map>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/objects/paint_raster.hpp"
#include "parkade/mapping/parking_map.hpp"

// Inside of painted_arrows.hpp: what a garage's arrows look like.

namespace parkade {

/// The common look of a garage's arrows of one kind: how often a map shows paint at each place of
/// the arrow's frame (origin in the middle of its length, on the shaft; x ahead, y left).
/// docs/math/grid.md.
class ArrowTemplate {
 public:
  /// A place of the frame, with log-likelihood ratios of what the map may show there: the arrow
  /// against bare floor. docs/math/grid.md, eq. (8).
  struct Place {
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    double paint = 0.0;  ///< log-likelihood ratio where the map shows paint
    double bare = 0.0;   ///< the same where it shows floor
  };

  /// Both sizes to either side of the origin, m; step: m, a cell.
  ArrowTemplate(double half_length, double half_width, double step);

  /// Adds what the map shows of an arrow, or of one that is its mirror image.
  void add(const PaintRaster& raster, const SE2& T_map_arrow, bool mirrored = false);
  /// To be called when all are added: works out the places.
  void finish();

  /// Those that arrows of this kind show paint at now and then.
  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  [[nodiscard]] bool isPaint(const Eigen::Vector2d& p) const;
  [[nodiscard]] double halfLength() const { return half_length_; }
  [[nodiscard]] double halfWidth() const { return half_width_; }
  /// Outline of its paint: a box in its frame, counter-clockwise.
  [[nodiscard]] std::vector<Eigen::Vector2d> outline() const;

  /// Log-likelihood ratio, of all cells, of an arrow there against bare floor.
  [[nodiscard]] double score(const PaintRaster& raster, const SE2& T_map_arrow) const;
  /// Moves a pose to where the score is best, within 0.3 m and 3 degrees.
  [[nodiscard]] SE2 align(const PaintRaster& raster, const SE2& T_map_arrow) const;

 private:
  [[nodiscard]] Eigen::Vector2d placeOf(int row, int column) const;

  double half_length_;
  double half_width_;
  double step_;
  cv::Mat1f seen_;  // rows along x
  cv::Mat1f shows_;
  std::vector<Place> places_;
};

/// By meaning, from the arrows that were told; kinds of which none was told have none.
std::map<std::string, ArrowTemplate> learnArrows(const PaintRaster& raster,
                                                 const std::vector<MapObject>& objects);

}  // namespace parkade
