// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Draws slots and line segments over a bird's-eye picture (CV_8UC3) of this geometry, which may be
/// enlarged already, enlarged by scale: slots green where free, red where occupied, yellow where
/// unknown, the entrance thick, doubtful ones dim, sides whose rear is not seen only half as deep;
/// segments in white.
cv::Mat drawSlots(const cv::Mat& image, const BevGeometry& geometry,
                  const std::vector<SlotObservation>& slots,
                  const std::vector<LineSegment>& segments, double scale = 1.0);

}  // namespace parkade
