// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/slots/bay_numbers.hpp"
#include "parkade/mapping/slots/row_completion.hpp"
#include "parkade/mapping/slots/slot_numbers.hpp"
#include "parkade/mapping/slots/slot_plausibility.hpp"
#include "parkade/mapping/slots/slot_registry_impl.hpp"
#include "parkade/mapping/slots/slot_track.hpp"

namespace parkade {

using slot_registry::Corners;
using slot_registry::SlotNumber;
using slot_registry::Track;

// Those told, ordered by id; of several on one place the one that explains more of what was seen.
std::vector<const Track*> SlotRegistry::Impl::distinct() const {
  std::vector<const Track*> order;
  for (const Track& track : tracks) {
    if (told(track)) order.push_back(&track);
  }
  const auto merit = [](const Track* track) {
    return track->support - 0.5 * static_cast<double>(track->misses);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const Track* a, const Track* b) { return merit(a) > merit(b); });
  constexpr double kLargest = 8.0;  // m
  std::vector<const Track*> chosen;
  for (const Track* track : order) {
    const bool taken = std::any_of(chosen.begin(), chosen.end(), [&](const Track* other) {
      return (track->centre() - other->centre()).norm() < kLargest &&
             overlapShare(track->corners(), other->corners()) > options.duplicate_overlap;
    });
    if (!taken) chosen.push_back(track);
  }
  std::sort(chosen.begin(), chosen.end(),
            [](const Track* a, const Track* b) { return a->id < b->id; });
  return chosen;
}

bool SlotRegistry::Impl::isPlausible(const MapSlot& slot, const std::vector<MapObject>& objects,
                                     const std::vector<DrivenStep>& driven) const {
  return !drivenThrough(slot.corners, driven) && !holdsRoadMarking(slot.corners, objects) &&
         !holdsPillar(slot.corners, objects, slot.observations);
}

std::vector<MapSlot> SlotRegistry::Impl::seenSlots(TimeNs now_ns,
                                                   const std::vector<MapObject>& objects) const {
  const std::vector<DrivenStep> driven = way.steps();
  std::vector<MapSlot> seen;
  for (const Track* track : distinct()) {
    if (std::find(replaced.begin(), replaced.end(), track->id) != replaced.end()) continue;
    MapSlot slot;
    slot.id = track->id;
    slot.corners = track->corners();
    slot.corner_sigma = std::sqrt(std::max(0.0, track->covariance.trace() / 4.0));
    slot.shape = static_cast<SlotShape>(
        std::max_element(track->shapes.begin(), track->shapes.end()) - track->shapes.begin());
    slot.probability_free =
        1.0 / (1.0 + std::exp(-fade(track->availability_ns, now_ns) * track->log_odds_free));
    slot.observations = track->observations;
    slot.last_seen_ns = track->last_seen_ns;
    if (isPlausible(slot, objects, driven)) seen.push_back(std::move(slot));
  }
  return seen;
}

// As it is told now: what the layers show of a filling is as old as what was seen of its neighbour.
MapSlot SlotRegistry::Impl::ofRow(MapSlot slot, TimeNs now_ns) const {
  const TimeNs then_ns = slot.observations > 0 ? completed_ns : slot.last_seen_ns;
  if (now_ns <= then_ns) return slot;
  const double log_odds = std::log(slot.probability_free / (1.0 - slot.probability_free));
  slot.probability_free = 1.0 / (1.0 + std::exp(-fade(then_ns, now_ns) * log_odds));
  return slot;
}

namespace {

// Slots stay told that only a filling which was refused would have replaced. seen: those told;
// added: the fillings that were not refused.
void keepBeatenByNone(const std::vector<MapSlot>& seen, const std::vector<MapSlot>& refused,
                      const std::vector<MapSlot>& added, std::vector<std::int64_t>& replaced) {
  constexpr double kTouches = 0.15;  // less is how neighbours lie
  const auto liesOn = [](const MapSlot& slot, const std::vector<MapSlot>& others) {
    return std::any_of(others.begin(), others.end(), [&](const MapSlot& other) {
      return overlapShare(slot.corners, other.corners) > kTouches;
    });
  };
  for (const MapSlot& slot : seen) {
    if (liesOn(slot, refused) && !liesOn(slot, added)) std::erase(replaced, slot.id);
  }
}

}  // namespace

void SlotRegistry::completeRows(TimeNs now_ns, const std::vector<MapObject>& objects,
                                const LayeredGrid& grid) {
  Impl& m = *impl_;
  const std::vector<DrivenStep> driven = m.way.steps();
  const std::vector<MapSlot> before = std::exchange(m.of_rows, {});
  m.replaced.clear();
  m.completed_ns = now_ns;
  const std::vector<MapSlot> seen = m.seenSlots(now_ns, objects);
  RowCompletion rows = parkade::completeRows(seen, objects, grid, m.options.rows);
  m.replaced = std::move(rows.replaced);
  std::vector<MapSlot> refused;
  for (MapSlot& slot : rows.added) {
    if (!m.isPlausible(slot, objects, driven)) {
      std::erase(m.replaced, slot.id);  // what was told and cannot be moved stays as it is
      if (slot.id == 0) refused.push_back(slot);
      continue;
    }
    const auto same = std::find_if(before.begin(), before.end(), [&](const MapSlot& other) {
      constexpr double kSame = 0.5;
      return overlapShare(slot.corners, other.corners) > kSame &&
             std::none_of(m.of_rows.begin(), m.of_rows.end(),
                          [&](const MapSlot& given) { return given.id == other.id; });
    });
    if (slot.id == 0) slot.id = same != before.end() ? same->id : m.next_id++;
    m.of_rows.push_back(slot);
  }
  keepBeatenByNone(seen, refused, m.of_rows, m.replaced);
}

std::vector<MapSlot> SlotRegistry::slots(TimeNs now_ns,
                                         const std::vector<MapObject>& objects) const {
  std::vector<MapSlot> result = impl_->seenSlots(now_ns, objects);
  for (const MapSlot& slot : impl_->of_rows) {
    const auto taken = [&](const MapSlot& other) {
      return overlapShare(slot.corners, other.corners) > impl_->options.duplicate_overlap;
    };
    if (std::none_of(result.begin(), result.end(), taken)) {
      result.push_back(impl_->ofRow(slot, now_ns));
    }
  }
  std::sort(result.begin(), result.end(),
            [](const MapSlot& a, const MapSlot& b) { return a.id < b.id; });
  std::vector<std::optional<SlotNumber>> numbers;
  for (MapSlot& slot : result) {
    // Looks share the errors of calibration and pose: many of them know corners no better than
    // that.
    if (slot.observations > 0) {
      slot.corner_sigma = std::hypot(slot.corner_sigma, impl_->options.corner_floor_m);
    }
    numbers.push_back(impl_->numbers.within(slot.corners));
    const Corners& c = slot.corners;
    const Eigen::Vector2d centre = 0.25 * (c[0] + c[1] + c[2] + c[3]);
    double nearest = impl_->options.zone_range_m;
    for (const MapObject& object : objects) {
      if (object.semantic_class != SemanticClass::kZoneMarker || object.text.empty()) continue;
      const double distance = (object.position.head<2>() - centre).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      slot.zone = object.text;
    }
  }
  keepSurestNumbers(numbers);
  std::vector<double> support(result.size(), 0.0);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (!numbers[i]) continue;
    result[i].number = numbers[i]->text;
    support[i] = numbers[i]->support;
  }
  slot_registry::numberBays(result, support);
  return result;
}

}  // namespace parkade
