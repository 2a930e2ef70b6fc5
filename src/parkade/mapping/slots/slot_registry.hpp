// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/core/time.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/slots/row_completion.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct SlotRegistryOptions {
  double association_sigma_m = 0.15;
  double gate_probability = 0.999;
  double corner_floor_m = 0.02;
  int min_observations = 3;
  double availability_gain = 0.4;
  double change_time_s = 600.0;
  double duplicate_overlap = 0.25;
  double zone_range_m = 15.0;
  double number_confidence = 0.9;
  int min_number_readings = 3;
  RowCompletionOptions rows;

  void visit(OptionVisitor& v) {
    v.field("association_sigma_m", association_sigma_m, "m",
            "What a slot's corners may lie off beside their covariances: errors of the pose.", 0.0,
            2.0);
    v.field("gate_probability", gate_probability, "probability",
            "Observations of a slot that are kept, of those that are one.", 0.5, 0.99999);
    v.field("corner_floor_m", corner_floor_m, "m",
            "A corner is not measured better than this, nor told to be by any number of looks.",
            1e-4, 1.0);
    v.field("min_observations", min_observations, "count", "Slots seen less often are not told.", 1,
            1000);
    v.field("availability_gain", availability_gain, "ratio",
            "Share of an observation's log-odds that is new.", 0.01, 1.0);
    v.field("change_time_s", change_time_s, "s",
            "Time after which what was seen of a slot says little: cars come and go.", 1.0, 1e7);
    v.field("duplicate_overlap", duplicate_overlap, "ratio",
            "Slots that share more of the smaller one's area are one.", 0.05, 1.0);
    v.field("zone_range_m", zone_range_m, "m",
            "A slot takes the zone of the marker next to its middle, if this near.", 0.0, 100.0);
    v.field("number_confidence", number_confidence, "probability",
            "Painted numbers are told when read this surely over all views.", 0.1, 0.999999);
    v.field("min_number_readings", min_number_readings, "count", "And this often.", 1, 1000);
    v.group("rows", rows);
  }
};

/// The parking slots that were seen: stable ids, corners fused over all observations, availability
/// as a Bayes filter over time. Readings of one place that do not agree are kept beside each other,
/// each with its own observations; the one that explains more of them is told, no slot twice. A
/// painted number is told of one slot only, the one where it is read most surely. World frame.
class SlotRegistry {
 public:
  explicit SlotRegistry(const SlotRegistryOptions& options);
  ~SlotRegistry();
  SlotRegistry(SlotRegistry&&) noexcept;
  SlotRegistry& operator=(SlotRegistry&&) noexcept;

  /// Enters what one frame shows. anchor: the pose that new slots hang on. new_view: false where
  /// the vehicle stands as in the frame before, so that only whether known slots are free is
  /// learned. labels: of the picture that the observations come from; where given, a slot is missed
  /// where they show the ground at its entrance.
  void update(const std::vector<SlotObservation>& observations, TimeNs t_ns,
              const SE2& T_world_vehicle, std::int64_t anchor, bool new_view = true,
              const BevLabels* labels = nullptr);

  /// Moves every slot with its anchor, then merges those that turn out to be one.
  /// correction(anchor): T_new_old, in the world.
  void moveWithAnchors(const std::function<SE2(std::int64_t)>& correction);

  /// Adds the slots that rows of the seen ones have beside them, by the map's layers
  /// (row_completion.hpp). They stay until the next call, or until an anchor moves.
  void completeRows(TimeNs now_ns, const std::vector<MapObject>& objects, const LayeredGrid& grid);

  /// The slots seen often enough that the vehicle did not drive through and that hold no pillar and
  /// none of the objects for who drives (arrows, stop lines, ...), and those of their rows, ordered
  /// by id; zones from the markers.
  /// Probabilities are as of now_ns: what was seen long ago has faded. Sigmas hold the errors that
  /// all looks share.
  [[nodiscard]] std::vector<MapSlot> slots(TimeNs now_ns,
                                           const std::vector<MapObject>& objects = {}) const;
  [[nodiscard]] int candidates() const;  ///< all, also those not told yet

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
