// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/semantics/standing/object_agents.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Draws objects over a bird's-eye picture (CV_8UC3) of this geometry, enlarged by scale: outlines
/// and places in their class's colour, headings as arrows, texts; boxes of vehicles and people with
/// their velocities (as far as they get in a second), what moves thicker.
cv::Mat drawObjects(const cv::Mat& image, const BevGeometry& geometry,
                    const std::vector<ObjectObservation>& objects,
                    const std::vector<MovingObservation>& moving, double scale = 1.0);

/// Detections of one picture as agents to draw, without ids and motion.
std::vector<MovingObservation> untracked(const std::vector<AgentDetection>& agents);

}  // namespace parkade
