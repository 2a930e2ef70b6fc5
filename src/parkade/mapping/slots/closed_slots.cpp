// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/closed_slots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/slots/outlined_place.hpp"
#include "parkade/mapping/slots/slot_axes.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

constexpr double kBin = 0.05;  // m

/// A painted line along x of its axes, at y.
struct Run {
  double y = 0.0;
  double begin = 0.0;
  double end = 0.0;
  std::size_t paint = 0;  // bins

  [[nodiscard]] double within(double from, double to) const {
    return std::max(0.0, std::min(end, to) - std::max(begin, from));
  }
};

// Cells of slot lines in axes turned by angle, by rows.
using PaintRows = std::map<int, std::vector<int>>;

PaintRows paintAlong(const LayeredGrid& grid, double angle) {
  const Eigen::Rotation2Dd turn(-angle);
  PaintRows rows;
  grid.forEachKnown(GridLayer::kParkingLines, [&](const Eigen::Vector2i& cell, const GridCell& c) {
    if (c.semantic_class != SemanticClass::kSlotLine) return;
    const Vector2d p = turn * grid.centerOf(cell);
    rows[static_cast<int>(std::floor(p.y() / kBin))].push_back(
        static_cast<int>(std::floor(p.x() / kBin)));
  });
  return rows;
}

// Stretches of a line's width that paint covers without long gaps.
std::vector<Run> runsOf(const PaintRows& rows) {
  constexpr int kGap = 8;         // bins
  constexpr double kLeast = 1.5;  // m
  constexpr double kFilled = 0.6;
  std::vector<Run> runs;
  for (const auto& [row, unused] : rows) {
    std::vector<int> bins;
    for (int r = row - 1; r <= row + 1; ++r) {
      const auto at = rows.find(r);
      if (at != rows.end()) bins.insert(bins.end(), at->second.begin(), at->second.end());
    }
    std::sort(bins.begin(), bins.end());
    bins.erase(std::unique(bins.begin(), bins.end()), bins.end());
    for (std::size_t i = 0, k = 0; i < bins.size(); i = k) {
      for (k = i + 1; k < bins.size() && bins[k] - bins[k - 1] <= kGap; ++k) {
      }
      const Run run{(row + 0.5) * kBin, bins[i] * kBin, (bins[k - 1] + 1) * kBin, k - i};
      const double length = run.end - run.begin;
      if (length < kLeast || static_cast<double>(run.paint) * kBin < kFilled * length) continue;
      runs.push_back(run);
    }
  }
  return runs;
}

// One of those that show the same line: the one with most paint.
std::vector<Run> distinct(std::vector<Run> runs) {
  constexpr double kSame = 0.25;  // m
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run& a, const Run& b) { return a.paint > b.paint; });
  std::vector<Run> kept;
  for (const Run& run : runs) {
    const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const Run& other) {
      return std::abs(run.y - other.y) < kSame && run.within(other.begin, other.end) > 0.0;
    });
    if (!is_known) kept.push_back(run);
  }
  return kept;
}

// In the middle of its paint.
void settle(const PaintRows& rows, Run& run) {
  constexpr int kHalf = 3;  // bins
  const int middle = static_cast<int>(std::floor(run.y / kBin));
  double sum = 0.0;
  double count = 0.0;
  for (auto row = rows.lower_bound(middle - kHalf); row != rows.upper_bound(middle + kHalf);
       ++row) {
    const auto in_run = std::count_if(row->second.begin(), row->second.end(), [&](int bin) {
      return bin * kBin >= run.begin && bin * kBin < run.end;
    });
    sum += (row->first + 0.5) * kBin * static_cast<double>(in_run);
    count += static_cast<double>(in_run);
  }
  run.y = sum / count;
}

std::vector<Run> linesAlong(const LayeredGrid& grid, double angle) {
  const PaintRows rows = paintAlong(grid, angle);
  std::vector<Run> runs = distinct(runsOf(rows));
  for (Run& run : runs) settle(rows, run);
  return runs;
}

// The same lines in axes turned by half a turn.
std::vector<Run> reversed(std::vector<Run> runs) {
  for (Run& run : runs) run = {-run.y, -run.end, -run.begin, run.paint};
  return runs;
}

class ClosedSlotFinder {
 public:
  ClosedSlotFinder(const std::vector<MapSlot>& told, const LayeredGrid& grid,
                   const SlotLikelihood& likelihood, const RowCompletionOptions& options)
      : told_(told), grid_(grid), likelihood_(likelihood), options_(options) {}

  /// Those that lie along the x axis of axes turned by angle. across: lines along x of axes turned
  /// by a quarter more.
  [[nodiscard]] std::vector<Filling> find(double angle, const std::vector<Run>& along,
                                          const std::vector<Run>& across) const {
    constexpr double kNarrow = 1.9;  // m
    constexpr double kWide = 2.8;
    std::vector<Filling> fillings;
    for (const Run& a : along) {
      for (const Run& b : along) {
        if (b.y - a.y < kNarrow || b.y - a.y > kWide) continue;
        for (const auto& [from, to] : endsBetween(a, b, across)) {
          const SE2 T(angle, Vector2d::Zero());
          const auto filling = weigh({T * Vector2d(from, a.y), T * Vector2d(to, a.y),
                                      T * Vector2d(to, b.y), T * Vector2d(from, b.y)});
          if (filling) fillings.push_back(*filling);
        }
      }
    }
    return fillings;
  }

 private:
  using Corners = std::array<Vector2d, 4>;

  // Pairs of lines from a to b, as far apart as such slots are long.
  static std::vector<std::pair<double, double>> endsBetween(const Run& a, const Run& b,
                                                            const std::vector<Run>& across) {
    constexpr double kShort = 5.4;  // m
    constexpr double kLong = 7.4;
    constexpr double kCovered = 0.7;
    std::vector<double> ends;  // along the axis; x of across runs up, their y back
    for (const Run& run : across) {
      if (run.within(a.y, b.y) > kCovered * (b.y - a.y)) ends.push_back(-run.y);
    }
    std::sort(ends.begin(), ends.end());
    std::vector<std::pair<double, double>> pairs;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (std::size_t k = i + 1; k < ends.size(); ++k) {
        const double length = ends[k] - ends[i];
        if (length < kShort || length > kLong) continue;
        if (std::min(a.within(ends[i], ends[k]), b.within(ends[i], ends[k])) < kCovered * length)
          continue;
        pairs.emplace_back(ends[i], ends[k]);
      }
    }
    return pairs;
  }

  [[nodiscard]] bool isPainted(const Vector2d& from, const Vector2d& to) const {
    constexpr double kContrast = 0.5;
    constexpr double kSeen = 0.6;
    constexpr double kFromCorner = 0.2;  // m
    const Vector2d u = (to - from).normalized();
    const SlotEvidence::Line line = lookAlong(grid_, from + kFromCorner * u, to - kFromCorner * u);
    return line.contrast() > kContrast &&
           line.seen_m > kSeen * ((to - from).norm() - 2.0 * kFromCorner);
  }

  // c: counter-clockwise, a long side first.
  [[nodiscard]] std::optional<Filling> weigh(const Corners& c) const {
    constexpr double kOverlap = 0.15;
    constexpr double kPrior = -4.0;
    for (const MapSlot& slot : told_) {
      if (overlapShare(slot.corners, c) > kOverlap) return std::nullopt;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      if (!isPainted(c[k], c[(k + 1) % 4])) return std::nullopt;
    }
    const Place place =
        outlinedPlace(c, SlotShape::kParallel, told_, grid_, options_.corner_sigma_m);
    const SlotEvidence& e = place.evidence;
    if (isDenied(e)) return std::nullopt;
    return oneSlot(place.slot,
                   kPrior + likelihood_.side(e.left) + likelihood_.side(e.right) +
                       likelihood_.side(e.rear) + likelihood_.side(e.entrance),
                   options_.min_log_odds);
  }

  const std::vector<MapSlot>& told_;
  const LayeredGrid& grid_;
  const SlotLikelihood& likelihood_;
  const RowCompletionOptions& options_;
};

}  // namespace

std::vector<Filling> findClosedSlots(const std::vector<MapSlot>& told, const LayeredGrid& grid,
                                     const SlotLikelihood& likelihood,
                                     const RowCompletionOptions& options) {
  const std::optional<double> axis = findAxis(told);
  if (!axis) return {};
  const ClosedSlotFinder finder(told, grid, likelihood, options);
  const std::vector<Run> along = linesAlong(grid, *axis);
  const std::vector<Run> across = linesAlong(grid, *axis + M_PI_2);
  std::vector<Filling> fillings = finder.find(*axis, along, across);
  for (Filling& filling : finder.find(*axis + M_PI_2, across, reversed(along))) {
    fillings.push_back(std::move(filling));
  }
  return fillings;
}

}  // namespace parkade::slot_rows
