// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "parkade/semantics/texts/level_camera.hpp"
#include "parkade/semantics/texts/zone_marker_faces.hpp"
#include "parkade/semantics/texts/zone_marker_outline.hpp"

namespace parkade {

/// A face as seen from straight ahead, sampled from the camera's picture. middle: height of the
/// marker's middle over the camera, in marker heights. Without a patch where the face does not
/// project into the camera.
ZoneMarkerFace straighten(const cv::Mat& image, const LevelCamera& view, const FittedFace& face,
                          double middle);

}  // namespace parkade
