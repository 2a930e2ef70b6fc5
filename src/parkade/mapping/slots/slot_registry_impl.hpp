// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "parkade/mapping/slots/slot_numbers.hpp"
#include "parkade/mapping/slots/slot_registry.hpp"
#include "parkade/mapping/slots/slot_track.hpp"

// Inside of the slot registry: slot_registry.cpp takes what is seen, slot_registry_told.cpp tells
// what is known.

namespace parkade {

struct SlotRegistry::Impl {
  SlotRegistryOptions options;
  std::vector<slot_registry::Track> tracks;  // ordered by id
  std::int64_t next_id = 1;
  DrivenWay way{0.1};                  // of the vehicle's origin
  std::vector<MapSlot> of_rows;        // that the rows have beside the tracks
  TimeNs completed_ns = 0;             // when they were told
  std::vector<std::int64_t> replaced;  // tracks in whose places those lie
  slot_registry::SlotNumbers numbers;

  explicit Impl(const SlotRegistryOptions& given)
      : options(given), numbers(given.min_number_readings, given.number_confidence) {}
  // What is left of what was known of a slot's availability then: cars come and go.
  [[nodiscard]] double fade(TimeNs then_ns, TimeNs now_ns) const {
    const double seconds = std::max(0.0, toSeconds(now_ns - then_ns));
    return std::exp(-seconds / options.change_time_s);
  }
  void judge(slot_registry::Track& track, const SlotObservation& seen, TimeNs t_ns) const;
  static void fuse(slot_registry::Track& track, const slot_registry::Seen& seen);
  void add(const slot_registry::Seen& seen, TimeNs t_ns, std::int64_t anchor);
  void countMisses(const SE2& T_world_vehicle, const BevLabels* labels,
                   const std::vector<bool>& was_seen);
  void forgetOdd();
  void mergeDuplicates();
  [[nodiscard]] std::vector<const slot_registry::Track*> distinct() const;
  [[nodiscard]] bool isPlausible(const MapSlot& slot, const std::vector<MapObject>& objects,
                                 const std::vector<DrivenStep>& driven) const;
  [[nodiscard]] std::vector<MapSlot> seenSlots(TimeNs now_ns,
                                               const std::vector<MapObject>& objects) const;
  [[nodiscard]] MapSlot ofRow(MapSlot slot, TimeNs now_ns) const;
  [[nodiscard]] bool told(const slot_registry::Track& track) const {
    // Seen rarely while in plain sight: something else.
    return track.observations >= options.min_observations &&
           track.misses <= 3 * track.observations + 5;
  }
};

}  // namespace parkade
