// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// What one labelled picture shows of an area of the floor, in shares of the area's samples.
struct AreaShares {
  double own = 0.0;      ///< labelled as the class that was asked for
  double rival = 0.0;    ///< labelled as other paint, where the class is paint
  double floor = 0.0;    ///< labelled as other ground
  double covered = 0.0;  ///< under something that stands there
  double unseen = 0.0;   ///< not seen: under the own car, beyond the picture or the range
};

/// The labels of one picture, asked area by area.
class LabelSight {
 public:
  /// range (m): from the picture's middle, beyond which ground counts as unseen. The labels must
  /// outlive it.
  LabelSight(const BevLabels& labels, double range) : labels_(labels), range_(range) {}

  /// Shares of the area of a convex outline, levelled vehicle frame; all unseen where it has fewer
  /// than 3 corners.
  [[nodiscard]] AreaShares of(const std::vector<Eigen::Vector2d>& outline,
                              SemanticClass semantic_class) const;
  /// Whether a point is within range.
  [[nodiscard]] bool reaches(const Eigen::Vector2d& p) const {
    return (p - labels_.geometry.center).squaredNorm() <= range_ * range_;
  }

 private:
  const BevLabels& labels_;
  double range_;
};

}  // namespace parkade
