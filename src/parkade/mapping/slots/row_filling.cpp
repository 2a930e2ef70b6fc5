// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/row_filling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

class GapFiller {
 public:
  GapFiller(const std::vector<MapSlot>& told, const Row& row, const Pattern& pattern,
            const LayeredGrid& grid, const SlotLikelihood& likelihood,
            const RowCompletionOptions& options)
      : told_(told),
        row_(row),
        pattern_(pattern),
        grid_(grid),
        likelihood_(likelihood),
        options_(options) {}

  // None where they are not likely.
  [[nodiscard]] Filling fill(const Gap& gap) const {
    if (isOpen(gap)) return extend(gap);
    return weigh(gap, placesOf(fitSlots(gap)), pattern_.is_wide);
  }

  // The same with wide slots, as for wheelchairs, of which there are few.
  [[nodiscard]] Filling fillWide(const Gap& gap) const {
    if (isOpen(gap) || pattern_.shape != SlotShape::kPerpendicular) return {};
    return weigh(gap, placesOf(fitWideSlots(gap)), true);
  }

 private:
  static bool isOpen(const Gap& gap) {
    return gap.at_begin == GapEnd::kOpen || gap.at_end == GapEnd::kOpen;
  }
  // How many slots fill a gap, if they do. Beside pillars they leave margins that other slots of
  // the garage leave as well: those seen most often, and that fit best.
  struct Fit {
    int count = 0;
    double begin = 0.0;
    double front = 0.0;
    double merit = 0.0;
  };
  [[nodiscard]] Fit fitSlots(const Gap& gap) const {
    const auto [before, after] = marginsOf(gap);
    const bool stretches = gap.at_begin == GapEnd::kSlot && gap.at_end == GapEnd::kSlot;
    const double length = gap.end - gap.begin;
    constexpr int kMost = 9;
    constexpr double kPerMetre = 10.0;  // sightings that outweigh a metre off
    Fit best;
    for (int count = 1; count <= kMost; ++count) {
      for (const Margin& b : before) {
        for (const Margin& a : after) {
          const double rest = length - count * pattern_.front - b.length - a.length;
          if (std::abs(rest) > options_.fit_m) continue;
          const double merit = b.seen + a.seen - kPerMetre * std::abs(rest);
          if (best.count > 0 && merit < best.merit) continue;
          const double front = pattern_.front + (stretches ? rest / count : 0.0);
          // What is left over lies beside the pillars.
          double begin = gap.begin + b.length;
          if (gap.at_begin == GapEnd::kPillar)
            begin += gap.at_end == GapEnd::kPillar ? 0.5 * rest : rest;
          best = {count, begin, front, merit};
        }
      }
    }
    return best;
  }

  // The same of slots as wide as such ones are: the margins that were seen most often, and all
  // that is left between them.
  [[nodiscard]] Fit fitWideSlots(const Gap& gap) const {
    const auto [before, after] = marginsOf(gap);
    Fit best;
    for (const Margin& b : before) {
      for (const Margin& a : after) {
        const double rest = gap.end - gap.begin - b.length - a.length;
        const int count = std::max(1, static_cast<int>(rest / kLeastWideFront));
        const double front = rest / count;
        if (front < kLeastWideFront || front > kMostWideFront) continue;
        const double merit = b.seen + a.seen;
        if (best.count > 0 && merit <= best.merit) continue;
        best = {count, gap.begin + b.length, front, merit};
      }
    }
    return best;
  }

  [[nodiscard]] std::pair<std::vector<Margin>, std::vector<Margin>> marginsOf(
      const Gap& gap) const {
    static const std::vector<Margin> kNone = {{0.0, 0}};
    return {gap.at_begin == GapEnd::kPillar ? pattern_.before : kNone,
            gap.at_end == GapEnd::kPillar ? pattern_.after : kNone};
  }

  [[nodiscard]] Place placeIn(double begin, double end) const {
    return placeAt(row_, pattern_, begin, end, told_, grid_, options_.corner_sigma_m);
  }

  [[nodiscard]] std::vector<Place> placesOf(const Fit& fit) const {
    std::vector<Place> places;
    for (int i = 0; i < fit.count; ++i) {
      const double begin = fit.begin + i * fit.front;
      places.push_back(placeIn(begin, begin + fit.front));
    }
    return places;
  }

  // Where nothing bounds a row each further slot must show itself.
  [[nodiscard]] Filling extend(const Gap& gap) const {
    Filling filling;
    const bool forwards = gap.at_end == GapEnd::kOpen;
    if ((forwards ? gap.at_begin : gap.at_end) != GapEnd::kSlot || !pattern_.of_row) return filling;
    constexpr int kMost = 3;
    constexpr double kPrior = -2.0;
    for (int i = 0; i < kMost; ++i) {
      const double begin =
          forwards ? gap.begin + i * pattern_.front : gap.end - (i + 1) * pattern_.front;
      const Place place = placeIn(begin, begin + pattern_.front);
      const SlotEvidence& e = place.evidence;
      const double log_odds = kPrior + likelihood_.side(forwards ? e.right : e.left) +
                              likelihood_.entrance(e.entrance) + SlotLikelihood::vehicle(e) +
                              likelihood_.number(e) + likelihood_.stop(e);
      if (isDenied(e) || likelihood_.lacksSide(e) || log_odds < options_.min_log_odds) break;
      filling.log_odds += log_odds;
      filling.merit += kPrior + likelihood_.whole(e);
      filling.slots.push_back(place.slot);
    }
    return filling;
  }

  // Whether a slot of this shape is next to the pillar at s, before it or behind.
  [[nodiscard]] bool hasSlotBy(double s, bool before) const {
    constexpr double kInside = 0.3;
    return std::any_of(row_.members.begin(), row_.members.end(), [&](const Member& m) {
      const double apart = before ? s - m.end : m.begin - s;
      return told_[m.slot].shape == pattern_.shape && apart > -kInside &&
             apart < 0.5 * pattern_.front;
    });
  }

  // The slot that ends, or begins, at s; null where there is none.
  [[nodiscard]] const MapSlot* slotAt(double s, bool ends) const {
    constexpr double kInside = 0.3;
    for (const Member& m : row_.members) {
      if (std::abs((ends ? m.end : m.begin) - s) < kInside) return &told_[m.slot];
    }
    return nullptr;
  }

  // Whether a slot of this shape would share its side with this neighbour: beside slanted slots
  // there is a triangle that is none's, and two slots along the aisle leave a gap for a pillar that
  // is often as wide as a slot into the row.
  [[nodiscard]] bool sharesSideWith(const MapSlot* neighbour) const {
    return neighbour == nullptr || neighbour->shape == pattern_.shape;
  }

  // Whether a slot of this shape would begin, or end, with its line, if only for a piece.
  [[nodiscard]] bool sharesLineWith(const MapSlot* neighbour) const {
    const bool is_slanted = pattern_.shape == SlotShape::kSlanted;
    return neighbour == nullptr || (neighbour->shape == SlotShape::kSlanted) == is_slanted;
  }

  /// What bounds a gap.
  struct Ends {
    bool after_slot = false;
    bool before_slot = false;
    bool past_begin = false;  // a slot on the other side of the pillar
    bool past_end = false;
    bool knows_begin = false;  // the line there is that of a known slot
    bool knows_end = false;
    [[nodiscard]] bool both() const { return after_slot && before_slot; }
    [[nodiscard]] bool none() const { return !after_slot && !before_slot; }
    [[nodiscard]] bool enclose() const {
      return (after_slot || past_begin) && (before_slot || past_end);
    }
  };
  [[nodiscard]] Ends endsOf(const Gap& gap) const {
    Ends ends;
    if (gap.at_begin == GapEnd::kSlot) {
      const MapSlot* const neighbour = slotAt(gap.begin, true);
      ends.after_slot = sharesSideWith(neighbour);
      ends.knows_begin = sharesLineWith(neighbour);
    }
    if (gap.at_end == GapEnd::kSlot) {
      const MapSlot* const neighbour = slotAt(gap.end, false);
      ends.before_slot = sharesSideWith(neighbour);
      ends.knows_end = sharesLineWith(neighbour);
    }
    ends.past_begin = hasSlotBy(gap.begin, true);
    ends.past_end = hasSlotBy(gap.end, false);
    return ends;
  }

  // Between two slots there is hardly room for anything else; a bay between two pillars may hold
  // anything; wide slots are seldom.
  [[nodiscard]] double priorOf(const Ends& ends, bool are_wide) const {
    constexpr double kBetween = 3.0;
    constexpr double kBeside = 1.0;
    constexpr double kAlone = -2.0;
    constexpr double kOtherShape = -1.0;
    constexpr double kNextBay = 1.5;
    constexpr double kSeldom = -3.0;
    double prior = ends.both() ? kBetween : ends.none() ? kAlone : kBeside;
    if (!ends.after_slot && ends.past_begin) prior += kNextBay;
    if (!ends.before_slot && ends.past_end) prior += kNextBay;
    if (!pattern_.of_row) prior += kOtherShape;
    if (are_wide) prior += kSeldom;
    return prior;
  }

  // As an entrance of the next row passes for the side of a slot along the aisle.
  [[nodiscard]] bool isLineOfOtherRow(const Vector2d& front, const Vector2d& rear) const {
    for (std::size_t i = 0; i < told_.size(); ++i) {
      if (liesOnLineOf(told_[i], front, rear) &&
          std::none_of(row_.members.begin(), row_.members.end(),
                       [&](const Member& m) { return m.slot == i; })) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool showsLines(const SlotEvidence& e) const {
    return std::max({likelihood_.side(e.left), likelihood_.side(e.right),
                     likelihood_.entrance(e.entrance)}) > 0.0;
  }

  [[nodiscard]] Filling weigh(const Gap& gap, const std::vector<Place>& places,
                              bool are_wide) const {
    const Ends ends = endsOf(gap);
    Filling filling;
    SlotEvidence::Line entrance;
    double known = 0.0;
    double vehicles = 0.0;
    bool is_bare = false;
    bool shows_lines = false;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const SlotEvidence& e = places[i].evidence;
      if (isDenied(e) || (!ends.enclose() && likelihood_.lacksSide(e))) return {};
      // Several wide ones fill any gap: where nobody looked a pillar may stand between usual ones.
      if (are_wide && e.seen < SlotEvidence::kLeastSeen) return {};
      is_bare = is_bare || likelihood_.lacksAllLines(e);
      shows_lines = shows_lines || showsLines(e);
      // Lines that known slots have as well say nothing new.
      const std::array<Vector2d, 4>& c = places[i].slot.corners;
      const bool knows_left = (i == 0 && ends.knows_begin) || isLineOfOtherRow(c[0], c[3]);
      (knows_left ? known : filling.merit) += likelihood_.side(e.left);
      if (i + 1 == places.size()) {
        const bool knows_right = ends.knows_end || isLineOfOtherRow(c[1], c[2]);
        (knows_right ? known : filling.merit) += likelihood_.side(e.right);
      }
      vehicles += SlotLikelihood::vehicle(e);
      filling.merit += likelihood_.number(e) + likelihood_.stop(e);
      entrance.painted += e.entrance.contrast() * e.entrance.seen_m;
      entrance.seen_m += e.entrance.seen_m;
      filling.slots.push_back(places[i].slot);
    }
    // Aisles cross between two pillars, and cars wait there.
    if (ends.none() && is_bare && !shows_lines) return {};
    // Slots of other shapes have their entrances there as well: they count once.
    if (entrance.seen_m > 0.0) entrance.painted /= entrance.seen_m;
    filling.merit += likelihood_.entrance(entrance);
    // Cars that wait or were read too large cover several places at once.
    constexpr double kOneCar = 2.4;
    // Nor do cars tell how wide slots are.
    const bool each_in_one = ends.both() || (ends.enclose() && !are_wide);
    filling.merit += each_in_one ? vehicles : std::min(vehicles, kOneCar);
    filling.log_odds = priorOf(ends, are_wide) + filling.merit;
    filling.merit = filling.log_odds + known;
    return filling.log_odds > options_.min_log_odds ? filling : Filling{};
  }

  const std::vector<MapSlot>& told_;
  const Row& row_;
  const Pattern& pattern_;
  const LayeredGrid& grid_;
  const SlotLikelihood& likelihood_;
  const RowCompletionOptions& options_;
};

}  // namespace

Place placeAt(const Row& row, const Pattern& pattern, double begin, double end,
              const std::vector<MapSlot>& told, const LayeredGrid& grid, double sigma) {
  const Member& nearest = *std::min_element(
      row.members.begin(), row.members.end(), [&](const Member& a, const Member& b) {
        return std::abs(a.begin - begin) < std::abs(b.begin - begin);
      });
  Place place;
  place.slot = unseenSlot(pattern, row.at(begin), row.at(end), told[nearest.slot], sigma);
  place.evidence = gatherEvidence(grid, place.slot.corners);
  setFree(place.evidence, place.slot);
  return place;
}

std::vector<Filling> findFillings(const std::vector<MapSlot>& told,
                                  const std::vector<Vector2d>& pillars, const LayeredGrid& grid,
                                  const SlotLikelihood& likelihood,
                                  const RowCompletionOptions& options) {
  std::vector<Filling> fillings;
  const std::vector<Row> rows = findRows(told);
  const std::vector<std::vector<Pattern>> patterns = findPatterns(rows, told, pillars);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    for (const Pattern& pattern : patterns[i]) {
      const GapFiller filler(told, row, pattern, grid, likelihood, options);
      for (const Gap& gap : findGaps(row, pattern, pillars, options.reach_m)) {
        for (const Filling& filling : {filler.fill(gap), filler.fillWide(gap)}) {
          if (!filling.slots.empty()) fillings.push_back(filling);
        }
      }
    }
  }
  return fillings;
}

}  // namespace parkade::slot_rows
