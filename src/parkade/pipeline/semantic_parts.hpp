// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/result.hpp"
#include "parkade/fusion/dead_reckoning.hpp"
#include "parkade/pipeline/mapping_run.hpp"
#include "parkade/pipeline/semantic_front_end.hpp"
#include "parkade/pipeline/semantic_mapper.hpp"

namespace parkade {

/// What a method that uses semantics works with.
struct SemanticParts {
  std::unique_ptr<SemanticFrontEnd> front_end;
  std::unique_ptr<SemanticMapper> mapper;
  std::unique_ptr<DeadReckoning> reckoning;  ///< null where key points are its odometry
};

/// method: any but kVis (checked). masks: of the own body, one a camera, empty where there is none.
/// Fails where a network cannot be read or does not suit the pictures.
Result<SemanticParts> makeSemanticParts(const Rig& rig, const std::vector<cv::Mat>& masks,
                                        const PipelineOptions& options, RunMethod method);

}  // namespace parkade
