// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/result.hpp"

namespace parkade {

/// Share of each camera's image that another camera sees as well: element (a, b) of the result is
/// the share of a's pixels whose ray, at some depth from 1 m on, falls into b's image.
std::vector<std::vector<double>> computeOverlap(const Rig& rig);

/// Where a camera model sees at all (the circle of a fisheye): CV_8UC1, 255 inside.
cv::Mat validityMask(const Camera& camera);

/// The body masks that the rig names, one per camera, CV_8UC1, 0 where the own car hides the world;
/// empty where the rig names none. Fails on a file that is missing or of another size.
Result<std::vector<cv::Mat>> readBodyMasks(const Rig& rig);

}  // namespace parkade
