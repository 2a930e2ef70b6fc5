// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "parkade/cli/semantic_samples.hpp"
#include "parkade/core/random.hpp"
#include "parkade/core/result.hpp"
#include "parkade/semantics/networks/segmentation.hpp"

namespace parkade::cli {

/// Training data for the reading of texts: what a camera shows of zone markers, of signs and of
/// numbers in slots, straightened as the running program does.
class TextSampler {
 public:
  /// view_network: class map of the network for camera views; empty: Parkade's own, and faces by
  /// true labels alone where that is not installed.
  static Result<TextSampler> make(const std::string& view_network);

  /// STEM_texts.png, patches one below the other, and STEM_texts.csv with a line for each: the text
  /// (empty: none that could be read), height_px, slant_deg, distance_m, and what the patch was cut
  /// out by: true (the true labels of a marker), shaken (those with their edges moved), network,
  /// guide and limit (signs, by either labels), number (in a slot), turned (a number upside down,
  /// which is no text). Writes nothing where there is no patch.
  Status write(const SemanticSampler& sampler, const SemanticSample& sample, int camera,
               const std::string& stem);

 private:
  explicit TextSampler(std::optional<SegmentationNetwork> network) : network_(std::move(network)) {}
  std::optional<SegmentationNetwork> network_;
};

}  // namespace parkade::cli
