// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/cli/semantic_samples.hpp"
#include "parkade/semantics/bev_views.hpp"
#include "parkade/semantics/standing/object_boxes.hpp"

namespace parkade::cli {

/// An object of a simulated garage, in a sample's levelled vehicle frame.
struct TrueObject {
  SemanticClass semantic_class = SemanticClass::kUnknown;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< as ObjectObservation means it
  double heading = 0.0;
  std::string text;
  GroundBox box;          ///< footprint of what stands upright
  bool in_sight = false;  ///< whole in the picture and nothing before it: it must be found
};

/// Everything in a sample's picture that an object may be found for.
std::vector<TrueObject> trueObjects(const SemanticSampler& sampler, const SemanticSample& sample,
                                    const BevViews& views);

}  // namespace parkade::cli
