// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "parkade/core/result.hpp"
#include "parkade/eval/map_evaluation.hpp"

namespace parkade {

/// A map over the truth (CV_8UC3, BGR; a pixel is a cell of the map, north up, in the map's frame).
/// Painted cells: grey where map and truth agree within a cell, red where only the map has paint,
/// blue where only the truth has and the map knows the place. Slots of the truth near the way:
/// thin green where found, thick orange where missed; slots of the map that are none: thick
/// magenta; errors of entrance corners ten times as long, dark red. The way is light blue. Fails
/// where the map is empty or too wide for one picture.
Result<cv::Mat> drawMapErrors(const ParkingMap& map, const MapTruth& truth,
                              const MapEvaluation& evaluation);

}  // namespace parkade
