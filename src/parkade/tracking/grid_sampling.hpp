// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace parkade {

/// Largest radius that sampleGrid takes, in samples.
inline constexpr int kMostGridRadius = 8;

/// Bilinear samples of a CV_8UC1 image at pixel + warp * (x, y) for x, y in -radius..radius, row by
/// row, into out: (2 radius + 1)^2 floats. False where one of them leaves the image. Processors
/// with AVX2 take eight samples at a time, to the bit the same as others.
bool sampleGrid(const cv::Mat& image, const Eigen::Vector2d& pixel, const Eigen::Matrix2d& warp,
                int radius, float* out);

}  // namespace parkade
