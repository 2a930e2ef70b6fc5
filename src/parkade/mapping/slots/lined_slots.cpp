// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/lined_slots.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parkade/mapping/slots/row_sides.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

// A line that goes in from the entrances.
struct Side {
  double s = 0.0;
  bool is_known = false;  // of a slot of the row
};

class LinedSlotFinder {
 public:
  LinedSlotFinder(const std::vector<MapSlot>& told, const std::vector<Vector2d>& pillars,
                  const Row& row, const Pattern& pattern, const LayeredGrid& grid,
                  const SlotLikelihood& likelihood, const RowCompletionOptions& options)
      : told_(told),
        pillars_(pillars),
        row_(row),
        pattern_(pattern),
        grid_(grid),
        likelihood_(likelihood),
        options_(options) {}

  [[nodiscard]] std::vector<Filling> find() const {
    const std::vector<Side> sides = findSides();
    std::vector<Filling> fillings;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (std::size_t k = i + 1; k < sides.size(); ++k) {
        const double width = sides[k].s - sides[i].s;
        if (width > std::max(kMostWideFront, 1.2 * pattern_.front)) break;
        const auto filling = weigh(sides[i], sides[k]);
        if (filling) fillings.push_back(*filling);
      }
    }
    return fillings;
  }

 private:
  // Those of the row's slots, and plain ones elsewhere; from left to right.
  [[nodiscard]] std::vector<Side> findSides() const {
    constexpr double kStep = 0.1;    // m
    constexpr double kApart = 0.35;  // m, of one line
    std::vector<Side> sides;
    double last = row_.members.front().end;
    for (const Member& m : row_.members) {
      sides.push_back({m.begin, true});
      sides.push_back({m.end, true});
      last = std::max(last, m.end);
    }
    const std::size_t known = sides.size();
    const auto is_taken = [&](double s) {
      return std::any_of(sides.begin(), sides.end(),
                         [&](const Side& side) { return std::abs(side.s - s) < kApart; });
    };
    const double first = row_.members.front().begin;
    std::vector<std::pair<double, double>> plain;  // paint, place
    for (double s = first - options_.reach_m; s < last + options_.reach_m; s += kStep) {
      if (isInMember(s, s)) continue;
      const SlotEvidence::Line line = sideAt(grid_, row_, pattern_, s);
      if (isPlain(line)) plain.emplace_back(line.paint(), s);
    }
    std::stable_sort(plain.begin(), plain.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [paint, s] : plain) {
      if (is_taken(s)) continue;
      const double middle = settleSide(grid_, row_, pattern_, s);
      if (!is_taken(middle)) sides.push_back({middle, false});
    }
    if (sides.size() == known) return {};
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.s < b.s; });
    return sides;
  }

  static bool isPlain(const SlotEvidence::Line& line) {
    constexpr double kContrast = 0.3;
    constexpr double kPaint = 0.8;  // m
    return line.contrast() > kContrast && line.paint() > kPaint;
  }

  // Whether a slot of the row lies between, by more than slots' corners err by.
  [[nodiscard]] bool isInMember(double begin, double end) const {
    constexpr double kInto = 0.3;  // m
    return std::any_of(row_.members.begin(), row_.members.end(), [&](const Member& m) {
      return begin < m.end - kInto && end > m.begin + kInto;
    });
  }

  [[nodiscard]] bool hasPillar(double begin, double end) const {
    constexpr double kInto = 0.3;  // m
    return std::any_of(pillars_.begin(), pillars_.end(), [&](const Vector2d& p) {
      if (!standsIn(row_, pattern_, p)) return false;
      const double s = alongRow(row_, pattern_, p);
      return s > begin + kInto && s < end - kInto;
    });
  }

  [[nodiscard]] bool isWide(double width) const {
    return pattern_.shape == SlotShape::kPerpendicular && width > kLeastWideFront &&
           width < kMostWideFront;
  }

  [[nodiscard]] std::optional<Filling> weigh(const Side& left, const Side& right) const {
    constexpr double kOff = 0.08;  // of the front
    constexpr double kPrior = -2.0;
    constexpr double kSeldom = -1.5;
    constexpr double kPlain = 1.0;  // such a line hardly lies there by chance
    const double width = right.s - left.s;
    const bool is_usual = std::abs(width - pattern_.front) < kOff * pattern_.front;
    if ((!is_usual && !isWide(width)) || (left.is_known && right.is_known)) return std::nullopt;
    if (isInMember(left.s, right.s) || hasPillar(left.s, right.s)) return std::nullopt;
    const Place place =
        placeAt(row_, pattern_, left.s, right.s, told_, grid_, options_.corner_sigma_m);
    const SlotEvidence& e = place.evidence;
    if (isDenied(e) || likelihood_.lacksSide(e)) return std::nullopt;
    const double entrance = isPlain(e.entrance) ? likelihood_.entrance(e.entrance) + kPlain : 0.0;
    const double inside = likelihood_.number(e) + likelihood_.stop(e);
    const double vehicle = SlotLikelihood::vehicle(e);
    // Two lines alone may bound anything.
    if (entrance <= 0.0 && inside <= 0.0 && vehicle <= 0.0) return std::nullopt;
    Filling filling;
    double known = 0.0;
    const auto add = [&](const Side& side, const SlotEvidence::Line& line) {
      (side.is_known ? known : filling.log_odds) += likelihood_.side(line);
      if (!side.is_known) filling.log_odds += kPlain;
    };
    add(left, e.left);
    add(right, e.right);
    filling.log_odds += kPrior + (is_usual ? 0.0 : kSeldom) + entrance + inside + vehicle;
    if (filling.log_odds < options_.min_log_odds) return std::nullopt;
    filling.merit = filling.log_odds + known;
    filling.slots.push_back(place.slot);
    return filling;
  }

  const std::vector<MapSlot>& told_;
  const std::vector<Vector2d>& pillars_;
  const Row& row_;
  const Pattern& pattern_;
  const LayeredGrid& grid_;
  const SlotLikelihood& likelihood_;
  const RowCompletionOptions& options_;
};

}  // namespace

std::vector<Filling> findLinedSlots(const std::vector<MapSlot>& told,
                                    const std::vector<Vector2d>& pillars, const LayeredGrid& grid,
                                    const SlotLikelihood& likelihood,
                                    const RowCompletionOptions& options) {
  std::vector<Filling> fillings;
  const std::vector<Row> rows = findRows(told);
  const std::vector<std::vector<Pattern>> patterns = findPatterns(rows, told, pillars);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const Pattern& pattern : patterns[i]) {
      if (!pattern.of_row) continue;
      const LinedSlotFinder finder(told, pillars, rows[i], pattern, grid, likelihood, options);
      for (Filling& filling : finder.find()) fillings.push_back(std::move(filling));
    }
  }
  return fillings;
}

}  // namespace parkade::slot_rows
