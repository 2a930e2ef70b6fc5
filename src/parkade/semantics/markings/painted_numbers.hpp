// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "parkade/camera/camera.hpp"
#include "parkade/core/options.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct PaintedNumberOptions {
  double min_height_m = 0.12;
  double max_height_m = 1.2;
  double min_height_px = 6.0;

  void visit(OptionVisitor& v) {
    v.field("min_height_m", min_height_m, "m", "Lower paint is no number.", 0.01, 5.0);
    v.field("max_height_m", max_height_m, "m", "Higher paint is none either: a sign.", 0.01, 10.0);
    v.field("min_height_px", min_height_px, "px",
            "Numbers lower than this in the camera's picture are not read.", 1.0, 1000.0);
  }
};

/// A number painted in a slot or on the aisle: a rectangle of the ground, in the levelled vehicle
/// frame.
struct PaintedNumber {
  std::size_t object = 0;                            ///< of the frame's objects
  std::optional<std::size_t> slot;                   ///< of its slots, the one that it lies in
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< m
  /// Unit, from the left to the right of its reader: of a slot, who stands before the entrance.
  Eigen::Vector2d right = Eigen::Vector2d::UnitX();
  double width = 0.0;   ///< m, along right
  double height = 0.0;  ///< m, across it
  double radius = 0.0;  ///< m: a ring is painted this far from the middle; 0: none

  /// Unit, from its lower to its upper edge.
  [[nodiscard]] Eigen::Vector2d up() const { return {-right.y(), right.x()}; }
};

/// The painted numbers among the objects that lie in one of the slots, as wide and high as the
/// labels show them.
std::vector<PaintedNumber> findPaintedNumbers(const SemanticFrame& frame,
                                              const PaintedNumberOptions& options);

/// The number in the ring of a painted speed limit, one of the frame's objects (checked); none
/// where it has no outline. Which way it faces is not known: it is given as who looks along `up`
/// (unit) reads it.
std::optional<PaintedNumber> findPaintedLimit(const SemanticFrame& frame, std::size_t object,
                                              const Eigen::Vector2d& up);

/// Resolution of a number in a camera's picture: px of its height, by the axis that is seen worse;
/// 0 where a part of it is out of the picture or hidden by the own car. mask: CV_8UC1 of the
/// picture's size, 0 where the own car is; may be empty.
double seenHeight(const PaintedNumber& number, const Camera& camera, const cv::Mat& mask,
                  const SE3& T_level_cam);

/// The number as seen from above, upright for its reader, without the ring around it: CV_8UC3,
/// kZonePatchWidth x kZonePatchHeight, with the contrast and the margins that the reader of zone
/// texts expects. image: grey or BGR; the number lies in it (seenHeight() > 0).
cv::Mat straightenNumber(const PaintedNumber& number, const cv::Mat& image, const Camera& camera,
                         const SE3& T_level_cam);

}  // namespace parkade
