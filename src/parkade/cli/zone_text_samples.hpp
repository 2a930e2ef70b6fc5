// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/cli/semantic_samples.hpp"
#include "parkade/core/result.hpp"

namespace parkade::cli {

/// Training data for the reading of zone texts: STEM_texts.png, the straightened faces of all
/// markers in a camera's picture one below the other, and STEM_texts.csv with a line for each: the
/// text (empty: none that could be read), height_px, slant_deg and distance_m. labels: the camera's
/// true labels. Writes nothing where there is no face.
Status writeZoneTexts(const SemanticSampler& sampler, const SemanticSample& sample, int camera,
                      const cv::Mat& labels, const std::string& stem);

}  // namespace parkade::cli
