// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/row_completion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/slots/bay_ends.hpp"
#include "parkade/mapping/slots/closed_slots.hpp"
#include "parkade/mapping/slots/entrance_turning.hpp"
#include "parkade/mapping/slots/lined_slots.hpp"
#include "parkade/mapping/slots/lone_signs.hpp"
#include "parkade/mapping/slots/reserved_slots.hpp"
#include "parkade/mapping/slots/row_alignment.hpp"
#include "parkade/mapping/slots/row_evidence.hpp"
#include "parkade/mapping/slots/row_filling.hpp"
#include "parkade/mapping/slots/row_splitting.hpp"
#include "parkade/mapping/slots/slot_axes.hpp"
#include "parkade/mapping/slots/slot_likelihood.hpp"
#include "parkade/mapping/slots/slot_row.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using slot_rows::Filling;
using slot_rows::gatherEvidence;
using slot_rows::Member;
using slot_rows::Row;
using slot_rows::SlotEvidence;
using slot_rows::SlotLikelihood;

// Slots next to others of their row (at most one slot and a pillar between) that are shaped
// otherwise, as fewer of the row are, though seen more rarely.
std::vector<bool> findMisfits(const std::vector<MapSlot>& told) {
  std::vector<bool> misfits(told.size(), false);
  for (const Row& row : slot_rows::findRows(told)) {
    std::map<SlotShape, std::int64_t> looks;
    for (const Member& member : row.members) {
      looks[told[member.slot].shape] += told[member.slot].observations;
    }
    for (const Member& a : row.members) {
      for (const Member& b : row.members) {
        constexpr double kTouch = 0.8;  // m, a pillar between
        const MapSlot& slot = told[a.slot];
        const MapSlot& other = told[b.slot];
        const double apart = std::max(a.begin, b.begin) - std::min(a.end, b.end);
        const double slot_between = b.end - b.begin;
        if (apart < kTouch + slot_between && slot.observations < other.observations &&
            looks[slot.shape] < looks[other.shape]) {
          misfits[a.slot] = true;
        }
      }
    }
  }
  return misfits;
}

class RowCompleter {
 public:
  RowCompleter(const std::vector<MapSlot>& told, const std::vector<Vector2d>& pillars,
               const LayeredGrid& grid, const RowCompletionOptions& options)
      : told_(told), pillars_(pillars), grid_(grid), options_(options) {
    const slot_rows::SquaredSlots squared = slot_rows::squareSlots(told_, grid);
    noteMoved(squared.moved);
    dropTold(squared.wrong);
    noteMoved(slot_rows::turnBlockedSlots(told_, grid));
    noteMoved(slot_rows::turnSidewaysSlots(told_, grid));
    noteMoved(slot_rows::turnToAxes(told_));
    noteMoved(slot_rows::alignRows(told_));
    gatherMissing();
    for (const SlotEvidence& evidence : evidence_) likelihood_.learn(evidence);
    dropTold(findUnfounded());
    const std::vector<std::size_t> split =
        slot_rows::splitSlots(told_, pillars, grid, likelihood_, options);
    gatherMissing();
    dropTold(split);
    gone_.assign(told_.size(), false);
    misfits_ = findMisfits(told_);
  }

  RowCompletion complete() {
    std::vector<Filling> fillings =
        slot_rows::findFillings(told_, pillars_, grid_, likelihood_, options_);
    if (std::find(misfits_.begin(), misfits_.end(), true) != misfits_.end()) {
      std::vector<MapSlot> fitting;
      for (std::size_t i = 0; i < told_.size(); ++i) {
        if (!misfits_[i]) fitting.push_back(told_[i]);
      }
      for (Filling& filling :
           slot_rows::findFillings(fitting, pillars_, grid_, likelihood_, options_)) {
        fillings.push_back(std::move(filling));
      }
    }
    const std::vector<Vector2d> signs = slot_rows::findPaintedSigns(grid_);
    for (Filling& filling :
         slot_rows::findReservedSlots(signs, told_, pillars_, grid_, likelihood_, options_)) {
      fillings.push_back(std::move(filling));
    }
    RowCompletion result;
    takeBest(std::move(fillings), result.added);
    dropLonelySlots(result.added);
    const std::vector<MapSlot> ends =
        slot_rows::findBayEnds(knownWith(result.added), pillars_, grid_, likelihood_, options_);
    result.added.insert(result.added.end(), ends.begin(), ends.end());
    // A bay of which only the end was found has a row from now on.
    if (!ends.empty()) fillGaps(result.added);
    const std::size_t known = result.added.size();
    takeBest(
        slot_rows::findLinedSlots(knownWith(result.added), pillars_, grid_, likelihood_, options_),
        result.added);
    takeBest(slot_rows::findClosedSlots(knownWith(result.added), grid_, likelihood_, options_),
             result.added);
    takeBest(
        slot_rows::findLoneSignSlots(signs, knownWith(result.added), grid_, likelihood_, options_),
        result.added);
    if (result.added.size() > known) fillGaps(result.added);
    result.replaced = replaced_;
    for (std::size_t i = 0; i < told_.size(); ++i) {
      const bool is_new = told_[i].id == 0;
      const bool is_moved = moved_.count(told_[i].id) > 0;
      if (!gone_[i] && (is_new || is_moved)) result.added.push_back(told_[i]);
      if (!is_new && (gone_[i] || is_moved)) result.replaced.push_back(told_[i].id);
    }
    return result;
  }

 private:
  void noteMoved(const std::vector<std::size_t>& slots) {
    for (const std::size_t i : slots) moved_.insert(told_[i].id);
  }

  // Indices in their order.
  void dropTold(const std::vector<std::size_t>& slots) {
    for (std::size_t k = slots.size(); k-- > 0;) {
      const auto at = static_cast<std::ptrdiff_t>(slots[k]);
      replaced_.push_back(told_[slots[k]].id);
      told_.erase(told_.begin() + at);
      if (slots[k] < evidence_.size()) evidence_.erase(evidence_.begin() + at);
    }
  }

  // Slots of a few pictures that the map as a whole speaks against; and gaps, which look like slots
  // in every picture, and what has one line alone though it is in plain sight.
  [[nodiscard]] std::vector<std::size_t> findUnfounded() const {
    constexpr int kFewLooks = 10;
    constexpr double kOneLine = 1.0;  // log-odds; two lines make more than 3
    std::vector<std::size_t> unfounded;
    for (std::size_t i = 0; i < told_.size(); ++i) {
      const SlotEvidence& e = evidence_[i];
      const bool lacks_side = likelihood_.lacksSide(e);
      const bool is_none = isGapBetweenSlots(e) || (lacks_side && likelihood_.whole(e) < kOneLine);
      const bool has_few_looks = told_[i].observations < kFewLooks;
      if (is_none || (has_few_looks && (isDenied(e) || lacks_side))) unfounded.push_back(i);
    }
    return unfounded;
  }

  // Of the slots that came last.
  void gatherMissing() {
    for (std::size_t i = evidence_.size(); i < told_.size(); ++i) {
      evidence_.push_back(gatherEvidence(grid_, told_[i].corners));
    }
  }

  // What is left of the slots told, behind those added.
  [[nodiscard]] std::vector<MapSlot> knownWith(std::vector<MapSlot> added) const {
    for (std::size_t i = 0; i < told_.size(); ++i) {
      if (!gone_[i]) added.push_back(told_[i]);
    }
    return added;
  }

  // Sides of two bays with a gap between them look like a slot along the aisle; such ones have no
  // like in their row, and few pictures take them for one.
  void dropLonelySlots(const std::vector<MapSlot>& added) {
    constexpr int kFewLooks = 8;
    const std::vector<MapSlot> known = knownWith(added);
    std::set<std::int64_t> lonely;
    for (const Row& row : slot_rows::findRows(known)) {
      const MapSlot* along = nullptr;
      int parallel = 0;
      for (const Member& member : row.members) {
        if (known[member.slot].shape != SlotShape::kParallel) continue;
        along = &known[member.slot];
        ++parallel;
      }
      if (parallel == 1 && along->observations < kFewLooks && along->id != 0) {
        lonely.insert(along->id);
      }
    }
    for (std::size_t i = 0; i < told_.size(); ++i) {
      if (lonely.count(told_[i].id) > 0) gone_[i] = true;
    }
  }

  static double shareOf(const MapSlot& a, const MapSlot& b) {
    constexpr double kFar = 9.0;  // m
    if ((a.corners[0] - b.corners[0]).norm() > kFar) return 0.0;
    return overlapShare(a.corners, b.corners);
  }

  // The likeliest first.
  void takeBest(std::vector<Filling> fillings, std::vector<MapSlot>& added) {
    std::stable_sort(fillings.begin(), fillings.end(),
                     [](const Filling& a, const Filling& b) { return a.log_odds > b.log_odds; });
    for (const Filling& filling : fillings) {
      if (!takePlace(filling, added)) continue;
      added.insert(added.end(), filling.slots.begin(), filling.slots.end());
    }
  }

  // Of rows with what was added.
  void fillGaps(std::vector<MapSlot>& added) {
    takeBest(slot_rows::findFillings(knownWith(added), pillars_, grid_, likelihood_, options_),
             added);
  }

  // Whether nothing that is likelier lies where the filling does; what is less likely goes.
  bool takePlace(const Filling& filling, const std::vector<MapSlot>& added) {
    constexpr double kOverlap = 0.15;
    std::vector<std::size_t> beaten;
    for (const MapSlot& slot : filling.slots) {
      for (const MapSlot& other : added) {
        if (shareOf(slot, other) > kOverlap) return false;
      }
      for (std::size_t i = 0; i < told_.size(); ++i) {
        if (gone_[i] || shareOf(slot, told_[i]) <= kOverlap) continue;
        if (merit(i) >= filling.merit) return false;
        beaten.push_back(i);
      }
    }
    for (const std::size_t i : beaten) gone_[i] = true;
    return true;
  }

  // Log-odds of a slot that pictures told.
  [[nodiscard]] double merit(std::size_t i) const {
    constexpr double kPerLook = 0.2;
    constexpr double kMostLooks = 25.0;
    constexpr double kMisfit = -3.0;
    const double looks = std::min(kMostLooks, static_cast<double>(told_[i].observations));
    return likelihood_.whole(evidence_[i]) + kPerLook * looks + (misfits_[i] ? kMisfit : 0.0);
  }

  std::vector<MapSlot> told_;  // aligned and split; ids of 0: parts of what was told
  const std::vector<Vector2d>& pillars_;
  const LayeredGrid& grid_;
  const RowCompletionOptions& options_;
  std::set<std::int64_t> moved_;  // ids
  std::vector<std::int64_t> replaced_;
  std::vector<bool> gone_;
  std::vector<bool> misfits_;
  std::vector<SlotEvidence> evidence_;
  SlotLikelihood likelihood_;
};

}  // namespace

RowCompletion completeRows(const std::vector<MapSlot>& told, const std::vector<MapObject>& objects,
                           const LayeredGrid& grid, const RowCompletionOptions& options) {
  const std::vector<Vector2d> pillars = positionsOf(SemanticClass::kPillar, objects);
  return RowCompleter(told, pillars, grid, options).complete();
}

}  // namespace parkade
