// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/types/semantic_class.hpp"

namespace parkade {

/// One connected patch of marker labels and what stands around it.
struct MarkerBlob {
  std::vector<cv::Point> pixels;
  cv::Rect box;
  int covered = 0;        ///< pixels beside something that may hide a part
  int covered_aside = 0;  ///< of these, left or right of one
};

/// The patches of a class in a label picture, the highest first. What may hide a part is the
/// picture's border, the own car (0 in mask, which may be empty and of another size), and vehicles
/// and people; these hide nothing to their left and right where no pillar goes on above them: then
/// they stand behind it.
std::vector<MarkerBlob> findMarkerBlobs(const cv::Mat& labels, const cv::Mat& mask,
                                        SemanticClass wanted, int min_pixels);

}  // namespace parkade
