// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core/mat.hpp>

namespace parkade {

/// Straightened texts have this size; the text stands in the middle, grey beside it.
inline constexpr int kZonePatchWidth = 96;
inline constexpr int kZonePatchHeight = 40;
/// With what stands above and below it; so far apart lie the patches in it that are read.
inline constexpr int kTallPatchHeight = 72;
inline constexpr int kTallPatchStep = 8;

/// A pixel of no picture.
inline const Eigen::Vector2d kNoPixel(-10.0, -10.0);

/// Samples a picture (grey or BGR) as a patch of `rows` rows (a multiple of 4), CV_32FC3 (BGR).
/// pixel_at: the picture's pixel for a place of the patch, px right of and below its middle, or
/// kNoPixel; asked for at every fourth pixel, for between them even a face that turns away 1 m
/// before a fisheye bends by no more than 0.12 px. fine: samples along each axis of a pixel of the
/// patch, which are averaged.
cv::Mat sampleTextPatch(const cv::Mat& image, int rows, int fine,
                        const std::function<Eigen::Vector2d(double, double)>& pixel_at);

/// Brings a sampled patch to one brightness and contrast whatever its light, by what lies inside
/// `face`: mean 128 and standard deviation 40 there, grey beside it. CV_8UC3 afterwards.
void normaliseTextPatch(cv::Mat& patch, const cv::Rect& face);

}  // namespace parkade
