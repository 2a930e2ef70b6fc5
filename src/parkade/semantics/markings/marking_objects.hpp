// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/semantics/bev_views.hpp"
#include "parkade/semantics/markings/marking_shape.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct MarkingOptions {
  int min_confidence = 100;
  int min_pixels = 20;
  double sigma_px = 0.6;
  double min_overlap = 0.45;
  double min_arrow_m = 1.1;
  double min_lead = 0.03;

  void visit(OptionVisitor& v) {
    v.field("min_confidence", min_confidence, "of 255", "Less sure pixels are no paint.", 0, 255);
    v.field("min_pixels", min_pixels, "px", "Smaller pieces of paint are left out.", 1, 10000);
    v.field("sigma_px", sigma_px, "px", "Error of an object's place in a picture.", 0.01, 10.0);
    v.field("min_overlap", min_overlap, "ratio",
            "Intersection over union of an arrow with the shape that it is taken for.", 0.0, 1.0);
    v.field("min_arrow_m", min_arrow_m, "m", "Shorter things are no arrows.", 0.1, 10.0);
    v.field("min_lead", min_lead, "ratio",
            "By which the best meaning's overlap is above the next one's, to be told.", 0.0, 1.0);
  }
};

/// Painted and mounted objects on the floor, from the labels of a bird's-eye picture:
/// - arrow: the middle of its extent along the heading, on the shaft's axis; its heading; text: its
///   meaning (straight, left, right, straight_left, ...), empty where two meanings fit alike;
/// - speed limit: the middle of its ring; text and heading where the number can be read;
/// - stop line, crossing, speed bump, wheel stop: the middle of its box. No heading, for the two
///   directions across it look the same; the outline is the box;
/// - painted number: the middle of its box.
/// What the picture's border, the own car or something upright cuts off is left out: its place is
/// not known.
class MarkingExtractor {
 public:
  explicit MarkingExtractor(const MarkingOptions& options);

  /// attitude_sigma (rad): of the pitch and roll that the picture was levelled with.
  [[nodiscard]] std::vector<ObjectObservation> extract(const BevLabels& labels,
                                                       const BevViews& views,
                                                       double attitude_sigma) const;

 private:
  MarkingOptions options_;
  std::vector<MarkingShape> arrows_;
  std::vector<MarkingShape> limits_;
};

/// Covariance of a ground point: sigma (m) in the picture, and the attitude's error, which moves it
/// along the ray by (d^2 + h^2) / h and across it by h. z is 0 with the floor's unevenness.
Eigen::Matrix3d groundCovariance(const BevViews& views, const BevGeometry& geometry,
                                 const Eigen::Vector2d& p, double sigma, double attitude_sigma);

}  // namespace parkade
