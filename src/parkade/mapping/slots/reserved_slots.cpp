// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/reserved_slots.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "parkade/core/median.hpp"
#include "parkade/mapping/objects/paint_raster.hpp"
#include "parkade/mapping/slots/row_pattern.hpp"
#include "parkade/mapping/slots/row_sides.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

class ReservedSlotFinder {
 public:
  ReservedSlotFinder(const std::vector<MapSlot>& told, const std::vector<Vector2d>& pillars,
                     const LayeredGrid& grid, const SlotLikelihood& likelihood,
                     const RowCompletionOptions& options)
      : told_(told),
        pillars_(pillars),
        grid_(grid),
        likelihood_(likelihood),
        options_(options),
        wide_front_(wideFrontOf(told)) {}

  // The slot about a sign, if it lies in the row's depth and in none of its slots.
  [[nodiscard]] std::optional<Filling> find(const Row& row, const Pattern& pattern,
                                            const Vector2d& sign) const {
    constexpr double kMiddle = 0.2;  // of the depth: parts of a sign may be out of sight
    if (std::abs(depthShare(row, pattern, sign) - 0.5) > kMiddle) return std::nullopt;
    const double s = alongRow(row, pattern, sign);
    const std::optional<Room> room = roomAbout(row, pattern, s);
    if (!room) return std::nullopt;
    const std::optional<Front> front = fitFront(row, pattern, s, *room);
    return front ? weigh(row, pattern, *front) : std::nullopt;
  }

 private:
  struct Room {
    double low = 0.0;
    double high = 0.0;
  };
  struct Front {
    double begin = 0.0;
    double end = 0.0;
    double paint = 0.0;  // m, along both sides
  };

  // Between the slots and pillars next to s; none where s lies in a slot or far from all.
  [[nodiscard]] std::optional<Room> roomAbout(const Row& row, const Pattern& pattern,
                                              double s) const {
    constexpr double kPillar = 0.2;  // m, half a slender one
    Room room = {s - kMostWideFront, s + kMostWideFront};
    double nearest = 1e9;
    const auto bound = [&](double begin, double end) {
      if (end <= s) room.low = std::max(room.low, end);
      if (begin >= s) room.high = std::min(room.high, begin);
    };
    for (const Member& m : row.members) {
      if (s > m.begin && s < m.end) return std::nullopt;
      nearest = std::min({nearest, std::abs(m.begin - s), std::abs(m.end - s)});
      bound(m.begin, m.end);
    }
    if (nearest > options_.reach_m) return std::nullopt;
    for (const Vector2d& p : pillars_) {
      if (!standsIn(row, pattern, p)) continue;
      const double at = alongRow(row, pattern, p);
      bound(at - kPillar, at + kPillar);
    }
    return room;
  }

  [[nodiscard]] double paintAt(const Row& row, const Pattern& pattern, double s) const {
    return sideAt(grid_, row, pattern, s).paint();
  }

  // The sign is in the middle to a hand's breadth or two.
  [[nodiscard]] std::optional<Front> fitFront(const Row& row, const Pattern& pattern, double s,
                                              const Room& room) const {
    constexpr double kStep = 0.05;  // m
    constexpr double kOff = 0.2;
    constexpr double kPerMetre = 1.0;  // m of paint that outweigh a metre off
    constexpr double kInto = 0.15;     // m of what bounds the room, which is known no better
    const int widths = static_cast<int>(std::round((kMostWideFront - kLeastWideFront) / kStep));
    const int offs = static_cast<int>(std::round(kOff / kStep));
    std::optional<Front> best;
    double most = 0.0;
    for (int i = 0; i <= widths; ++i) {
      const double width = kLeastWideFront + i * kStep;
      for (int k = -offs; k <= offs; ++k) {
        const double begin = s + k * kStep - 0.5 * width;
        if (begin < room.low - kInto || begin + width > room.high + kInto) continue;
        const double paint = paintAt(row, pattern, begin) + paintAt(row, pattern, begin + width);
        const double score =
            paint - kPerMetre * (std::abs(width - wide_front_) + std::abs(k * kStep));
        if (best && score <= most) continue;
        most = score;
        best = Front{begin, begin + width, paint};
      }
    }
    if (best) {
      best->begin = settleSide(grid_, row, pattern, best->begin);
      best->end = settleSide(grid_, row, pattern, best->end);
    }
    return best;
  }

  [[nodiscard]] std::optional<Filling> weigh(const Row& row, const Pattern& pattern,
                                             const Front& front) const {
    constexpr double kSign = 3.0;    // hardly anything else is painted like that
    constexpr double kSigma = 0.12;  // m, of corners without paint
    constexpr double kSome = 1.0;    // m of paint
    const Place place = placeAt(row, pattern, front.begin, front.end, told_, grid_,
                                front.paint > kSome ? options_.corner_sigma_m : kSigma);
    const SlotEvidence& e = place.evidence;
    if (isDenied(e)) return std::nullopt;
    Filling filling;
    // Where the paint is worn the sign stands for it.
    filling.log_odds = kSign + std::max(0.0, likelihood_.side(e.left)) +
                       std::max(0.0, likelihood_.side(e.right)) +
                       std::max(0.0, likelihood_.entrance(e.entrance));
    filling.merit = filling.log_odds;
    filling.slots.push_back(place.slot);
    return filling;
  }

  const std::vector<MapSlot>& told_;
  const std::vector<Vector2d>& pillars_;
  const LayeredGrid& grid_;
  const SlotLikelihood& likelihood_;
  const RowCompletionOptions& options_;
  double wide_front_;
};

}  // namespace

double wideFrontOf(const std::vector<MapSlot>& told) {
  constexpr double kNorm = 3.5;  // m
  std::vector<double> fronts;
  for (const MapSlot& slot : told) {
    if (slot.shape != SlotShape::kPerpendicular) continue;
    const double front = (slot.corners[1] - slot.corners[0]).norm();
    if (front > kLeastWideFront && front < kMostWideFront) fronts.push_back(front);
  }
  return fronts.empty() ? kNorm : median(std::move(fronts));
}

std::vector<Vector2d> findPaintedSigns(const LayeredGrid& grid) {
  constexpr double kLeast = 0.85;  // m^2
  const double cell_m2 = grid.resolution() * grid.resolution();
  std::vector<Vector2d> signs;
  const PaintRaster numbers(grid, SemanticClass::kPaintedNumber);
  for (const std::vector<Vector2d>& patch : numbers.patches(0.0, 1)) {
    const auto cells = static_cast<double>(patch.size());
    if (cells * cell_m2 < kLeast) continue;
    signs.push_back(std::accumulate(patch.begin(), patch.end(), Vector2d(Vector2d::Zero())) /
                    cells);
  }
  return signs;
}

std::vector<Filling> findReservedSlots(const std::vector<Vector2d>& signs,
                                       const std::vector<MapSlot>& told,
                                       const std::vector<Vector2d>& pillars,
                                       const LayeredGrid& grid, const SlotLikelihood& likelihood,
                                       const RowCompletionOptions& options) {
  std::vector<Filling> fillings;
  if (signs.empty()) return fillings;
  const ReservedSlotFinder finder(told, pillars, grid, likelihood, options);
  const std::vector<Row> rows = findRows(told);
  const std::vector<std::vector<Pattern>> patterns = findPatterns(rows, told, pillars);
  for (const Vector2d& sign : signs) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto square = std::find_if(
          patterns[i].begin(), patterns[i].end(),
          [](const Pattern& pattern) { return pattern.shape == SlotShape::kPerpendicular; });
      if (square == patterns[i].end()) continue;
      if (const auto filling = finder.find(rows[i], *square, sign)) fillings.push_back(*filling);
    }
  }
  return fillings;
}

}  // namespace parkade::slot_rows
