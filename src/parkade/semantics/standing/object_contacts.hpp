// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/semantics/bev_views.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Where something upright meets the ground: ground points along the near edge of its labels.
struct ContactEdge {
  SemanticClass semantic_class = SemanticClass::kUnknown;
  int view = 0;                         ///< of BevViews: the one that most of it is seen from
  std::vector<Eigen::Vector2d> points;  ///< levelled vehicle frame, one per pixel
  double confidence = 0.0;              ///< mean of the labels', 0 to 1
  bool cut = false;  ///< one of its ends touches the picture's border, the own car, or other things
};

/// Finds near edges: pixels of a class with ground before them towards their camera. Edges of one
/// class closer than gap (m) belong together; with gap 0 those of one connected region. A zone
/// marker counts as its pillar.
class ContactFinder {
 public:
  ContactFinder(const BevGeometry& geometry, const BevViews& views);

  [[nodiscard]] std::vector<ContactEdge> find(const BevLabels& labels, SemanticClass semantic_class,
                                              double gap, int min_confidence, int min_pixels) const;

 private:
  BevGeometry geometry_;
  BevViews views_;
  /// CV_32SC3: of each pixel, the distances in memory to the three pixels before it, seen from its
  /// camera, side by side; 0 where it has none.
  cv::Mat before_;
};

}  // namespace parkade
