// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace parkade {

/// A network often mixes up what a stroke of paint is for part of its length: the last decimetres
/// of a slot's line become a lane line's, and the corner is lost. Gives each small piece of paint
/// (up to a tenth of a square metre) that touches a piece of other paint, at least twice as large,
/// the class of the largest such piece. labels: CV_8UC1, SemanticClass.
void uniteStrokes(cv::Mat& labels, double metres_per_px);

}  // namespace parkade
