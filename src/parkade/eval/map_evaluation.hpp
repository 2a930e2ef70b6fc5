// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/core/result.hpp"
#include "parkade/eval/layer_score.hpp"
#include "parkade/eval/loop_score.hpp"
#include "parkade/eval/map_truth.hpp"
#include "parkade/eval/statistics.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

struct MapEvaluationOptions {
  double passed_within_m = 8.0;
  double min_iou = 0.7;
  double max_turn_deg = 30.0;
  double object_distance_m = 1.0;
  double duplicate_overlap = 0.3;

  void visit(OptionVisitor& v) {
    v.field("passed_within_m", passed_within_m, "m",
            "Slots and objects that the vehicle's origin came this near to are judged.", 0.1,
            1000.0);
    v.field("min_iou", min_iou, "ratio",
            "A slot is found where one of the map shares this much of the union.", 0.05, 0.99);
    v.field("max_turn_deg", max_turn_deg, "deg", "And its entrance points the same way to this.",
            0.1, 180.0);
    v.field("object_distance_m", object_distance_m, "m",
            "An object is found where one of its class lies this near.", 0.01, 100.0);
    v.field("duplicate_overlap", duplicate_overlap, "ratio",
            "Two slots of the map are one twice where they share this much of the smaller.", 0.05,
            1.0);
  }
};

/// A slot of the truth that a slot of the map stands for.
struct SlotMatch {
  std::size_t map_slot = 0;
  std::size_t truth_slot = 0;
  double iou = 0.0;
  std::array<double, 4> corner_errors{};  ///< m; entrance left, right, rear right, left
};

struct SlotScore {
  int passed = 0;          ///< slots of the truth that were passed near enough
  int found = 0;           ///< of them
  int told = 0;            ///< slots of the map there
  int wrong = 0;           ///< of them, no slot of the truth
  int duplicates = 0;      ///< of them, the same slot again
  int in_sight = 0;        ///< passed ones of which the map has seen both entrance corners' floor
  int found_in_sight = 0;  ///< of them
  double recall = 0.0;
  double recall_in_sight = 0.0;
  double precision = 0.0;
  Statistics entrance_error;  ///< m, of the entrance corners of found slots
  Statistics corner_error;    ///< m, of all four corners
  /// m, of the entrance corners after the best rigid fit: the map's own shape, without the error
  /// of where it lies.
  Statistics fitted_entrance_error;
  int availability_right = 0;  ///< found slots whose availability is told, and rightly
  int availability_open = 0;   ///< found slots that the map calls neither free nor occupied
  double availability = 0.0;   ///< share of the found slots
  int numbers = 0;             ///< found slots with a painted number
  int numbers_right = 0;
  int numbers_wrong = 0;  ///< the others of them were not read
  int zones = 0;          ///< found slots that belong to a zone
  int zones_right = 0;
};

struct ObjectScore {
  int passed = 0;
  int found = 0;
  int told = 0;
  int wrong = 0;
  Statistics position_error;  ///< m, over the ground
  int texts = 0;              ///< found ones that bear a text
  int texts_right = 0;
  [[nodiscard]] double recall() const { return passed > 0 ? 1.0 * found / passed : 0.0; }
  [[nodiscard]] double precision() const { return told > 0 ? 1.0 - 1.0 * wrong / told : 0.0; }
};

/// How well a map agrees with the truth. Definitions: docs/evaluation.md, "Maps".
struct MapEvaluation {
  MapEvaluationOptions options;
  SE2 T_truth_map;
  SlotScore slots;
  std::vector<SlotMatch> matches;   ///< also of slots that were not passed near enough
  std::vector<std::size_t> missed;  ///< passed slots of the truth that were not found
  std::vector<std::size_t> wrong;   ///< slots of the map near the way that are none
  std::map<SemanticClass, ObjectScore> objects;
  std::map<GridLayer, LayerScore> layers;
  LoopScore loops;
};

/// Where the map's frame lies in the truth's: the map's first pose put on the truth's pose of that
/// instant, over the ground. Fails where the reference does not cover the instant.
Result<SE3> placeByFirstPose(TimeNs t_ns, const SE3& T_map_vehicle, const Trajectory& driven);

/// Fails where cells of the map lie too far apart to be compared, as a stray one far away.
Result<MapEvaluation> evaluateMap(const ParkingMap& map, const SE2& T_truth_map,
                                  const MapTruth& truth, const MapEvaluationOptions& options = {});

}  // namespace parkade
