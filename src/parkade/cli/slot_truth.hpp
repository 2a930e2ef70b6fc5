// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/cli/semantic_samples.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade::cli {

/// A slot of the simulated garage about the car, in the levelled vehicle frame.
struct TrueSlot {
  SlotObservation slot;
  bool occupied = false;
  bool counts = false;  ///< in the picture, its entrance in sight, its lines not worn away
};

/// The slots whose entrances lie within 1.5 times `reach` (m) of the picture's middle; those count
/// whose entrance corners lie within it and are plain to see in `truth`, the true labels.
std::vector<TrueSlot> trueSlots(const SemanticSampler& sampler, const SemanticSample& sample,
                                const BevLabels& truth, double reach);

}  // namespace parkade::cli
