// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/semantics/label_probe.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// A place where a slot may have an entrance corner: the end of a painted line, or where another
/// one meets it. Level frame.
struct SlotMark {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();        ///< on the middle of the lines
  Eigen::Vector2d inward = Eigen::Vector2d::UnitX();  ///< unit, along the side line
  Eigen::Vector2d across = Eigen::Vector2d::Zero();   ///< unit, along the line that meets; or zero
  double across_length = 0.0;                         ///< m, of that line, or 0
  int side = 0;                                       ///< index of the side line
  double visible = 0.0;                               ///< m of the side line, from the mark on
  double width = 0.0;                                 ///< m, of the side line
  double sigma_along = 0.0;                           ///< m, along inward, of the picture alone
  double sigma_aside = 0.0;                           ///< m, across inward, of the picture alone
  /// m, of the entrances in its row where the line is too faint for labels (slot_rows.hpp); or 0.
  double row_width = 0.0;
  bool is_lone = false;  ///< so faint, and no slot of its row is told

  bool is_bar = false;        ///< only the bar of a T is seen, no side line
  bool is_front_end = false;  ///< only the end of an entrance line is seen, no side line

  [[nodiscard]] bool isFaint() const { return row_width > 0.0; }
  /// A line along the entrance is all that is seen.
  [[nodiscard]] bool isSideless() const { return is_bar || is_front_end; }
};

/// Marks of all slot lines among the segments, both ways along each. The side line must end at its
/// mark: what goes on beyond (0.9 m) is no side of an entrance. Where a line's end is hidden by
/// more than a leg or a pole, or another line meets it, there is no open end; worn ends are
/// followed where the network holds them for paint nearly as much, and sides that point at a line
/// that reaches there, or at the middle of a bar, reach over 0.8 m of floor. Bars that no line
/// meets make marks both ways, with inward across them and side the bar itself (is_bar); the ends
/// of entrance lines make one with inward as that of the sides which meet them elsewhere
/// (is_front_end). grey: CV_8UC1, the picture that the labels are of; its edge places open ends to
/// a fraction of a pixel.
std::vector<SlotMark> findSlotMarks(const cv::Mat& grey, const LabelProbe& probe,
                                    const std::vector<LineSegment>& segments);

}  // namespace parkade
