// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "parkade/types/semantic_class.hpp"

namespace parkade {

/// The colour that stands for a class in pictures: blue, green, red.
std::array<std::uint8_t, 3> colourOf(SemanticClass semantic_class);

/// Lays the classes' colours over a picture (CV_8UC3 BGR or CV_8UC1 grey), share of them 0 to 1.
/// Where the class is unknown or floor the picture stays. Labels of another size are stretched.
cv::Mat drawLabels(const cv::Mat& image, const cv::Mat& labels, double share = 0.5);

}  // namespace parkade
