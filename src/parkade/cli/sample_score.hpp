// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "parkade/cli/semantic_samples.hpp"
#include "parkade/core/result.hpp"
#include "parkade/semantics/texts/zone_marker_faces.hpp"

namespace parkade::cli {

/// One part of `parkade bench semantics`: gets every sample in turn, and tells its table at the
/// end.
class SampleScore {
 public:
  virtual ~SampleScore() = default;

  /// A garage's samples begin; what goes on over time starts anew.
  virtual Status begin(const SemanticSampler& sampler) = 0;
  virtual Status add(const SemanticSampler& sampler, const SemanticSample& sample) = 0;
  /// The table for people.
  [[nodiscard]] virtual std::string table() const = 0;
  /// Its part of metrics.json, under keys of its own.
  virtual void writeTo(nlohmann::json& metrics) const = 0;
};

struct SegmentationScoreOptions {
  std::string bev_network;  ///< class map; empty: Parkade's own
  std::string raw_network;  ///< the same for camera views; empty: Parkade's own where it is there
  std::string pictures;     ///< folder for pictures with found and true labels; empty: none
};

/// Intersection over union of both networks' classes.
Result<std::unique_ptr<SampleScore>> makeSegmentationScore(const SegmentationScoreOptions& options);

struct ObjectScoreOptions {
  std::string bev_network;         ///< class map; empty: Parkade's own
  bool true_labels = false;        ///< features from the true labels instead of the network's
  std::string pictures;            ///< folder for pictures with found and true objects; empty: none
  double attitude_sigma = 0.0035;  ///< rad, of the attitude that pictures are stitched with
  double height_sigma = 0.005;     ///< m, the same
};

/// Precision, recall and errors of objects on the floor, pillars, vehicles and people.
Result<std::unique_ptr<SampleScore>> makeObjectScore(const ObjectScoreOptions& options);

struct SlotScoreOptions {
  std::string bev_network;         ///< class map; empty: Parkade's own
  bool true_labels = false;        ///< features from the true labels instead of the network's
  std::string pictures;            ///< folder for pictures with found and true slots; empty: none
  double attitude_sigma = 0.0035;  ///< rad, of the attitude that pictures are stitched with
  double height_sigma = 0.005;     ///< m, of the height
  std::string trials;  ///< CSV file of all candidates with their clues and truth; empty: none
};

/// Precision, recall, entrance corners and availability of parking slots.
Result<std::unique_ptr<SampleScore>> makeSlotScore(const SlotScoreOptions& options);

struct ZoneTextScoreOptions {
  std::string view_network;  ///< class map; empty: Parkade's own
  bool true_labels = false;  ///< markers from the true labels instead of the network's
  std::string pictures;      ///< folder for straightened faces; empty: none
  ZoneMarkerFaceOptions faces;
};

/// Zone texts in single camera views: those read rightly, by distance.
Result<std::unique_ptr<SampleScore>> makeZoneTextScore(const ZoneTextScoreOptions& options);

}  // namespace parkade::cli
