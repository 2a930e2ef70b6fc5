// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/stamps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "parkade/core/log.hpp"
#include "parkade/core/median.hpp"

namespace parkade {
namespace {

constexpr TimeNs kPeriodsPerWindow = 10;
constexpr std::size_t kMaxPieces = 1000;
constexpr std::size_t kMinRows = 3;
constexpr double kMinShareOutside = 0.9;

using Rows = std::vector<std::size_t>;

// Rows of one clock, sorted by stamp and, within a stamp, by row.
struct Piece {
  Rows rows;
  std::size_t late = 0;
};

// Median step between different stamps once sorted; of interleaved clocks a little too small.
TimeNs medianPeriod(std::vector<TimeNs> sorted) {
  std::sort(sorted.begin(), sorted.end());
  std::vector<TimeNs> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] > sorted[i - 1]) steps.push_back(sorted[i] - sorted[i - 1]);
  }
  if (steps.empty()) return 0;
  return median(std::move(steps));
}

Result<std::vector<Piece>> splitByClock(const std::vector<TimeNs>& t_ns, TimeNs window) {
  std::vector<Piece> pieces;
  for (std::size_t row = 0; row < t_ns.size(); ++row) {
    Piece* nearest = nullptr;
    TimeNs nearest_step = window;
    for (Piece& piece : pieces) {
      const TimeNs step = std::abs(t_ns[row] - t_ns[piece.rows.back()]);
      if (step < nearest_step || (nearest == nullptr && step == nearest_step)) {
        nearest = &piece;
        nearest_step = step;
      }
    }
    if (nearest == nullptr) {
      if (pieces.size() == kMaxPieces) {
        return Error{fmt::format(
            "the stamps fall into more than {} pieces (steps above {:.1f} ms in both directions): "
            "there is no order to recover",
            kMaxPieces, toSeconds(window) * 1e3)};
      }
      pieces.emplace_back();
      nearest = &pieces.back();
    }
    Rows& rows = nearest->rows;
    const auto place =
        std::upper_bound(rows.begin(), rows.end(), t_ns[row],
                         [&t_ns](TimeNs t, std::size_t other) { return t < t_ns[other]; });
    if (place != rows.end()) ++nearest->late;
    rows.insert(place, row);
  }
  return pieces;
}

// Rule 2: the first row of each stamp; returns how many were dropped.
std::size_t dropRepeats(const std::vector<TimeNs>& t_ns, Rows& rows) {
  const auto end = std::unique(rows.begin(), rows.end(), [&t_ns](std::size_t a, std::size_t b) {
    return t_ns[a] == t_ns[b];
  });
  const auto dropped = static_cast<std::size_t>(rows.end() - end);
  rows.erase(end, rows.end());
  return dropped;
}

}  // namespace

StampReport checkStamps(const std::vector<TimeNs>& t_ns) {
  StampReport report;
  report.rows = t_ns.size();
  for (std::size_t i = 1; i < t_ns.size(); ++i) {
    const TimeNs step = t_ns[i] - t_ns[i - 1];
    if (step > 0) continue;
    if (report.clean()) report.first_row = i;
    ++(step < 0 ? report.backward : report.repeated);
    report.largest_back_ns = std::max(report.largest_back_ns, -step);
  }
  return report;
}

Result<StampRepair> repairStamps(const std::vector<TimeNs>& t_ns) {
  StampRepair repair;
  repair.window_ns = kPeriodsPerWindow * medianPeriod(t_ns);
  Result<std::vector<Piece>> split = splitByClock(t_ns, repair.window_ns);
  if (!split) return split.error();
  std::vector<Piece>& pieces = *split;
  repair.pieces = pieces.size();

  std::size_t repeats = 0;
  for (Piece& piece : pieces) repeats += dropRepeats(t_ns, piece.rows);
  const auto duration = [&t_ns](const Piece& piece) {
    return t_ns[piece.rows.back()] - t_ns[piece.rows.front()];
  };
  std::stable_sort(pieces.begin(), pieces.end(), [&duration](const Piece& a, const Piece& b) {
    return duration(a) > duration(b);
  });
  std::vector<std::pair<TimeNs, TimeNs>> kept_spans;
  for (const Piece& piece : pieces) {
    if (piece.rows.size() < kMinRows && !kept_spans.empty()) continue;
    Rows outside;
    for (const std::size_t row : piece.rows) {
      const bool inside = std::any_of(kept_spans.begin(), kept_spans.end(), [&](const auto& span) {
        return t_ns[row] >= span.first && t_ns[row] <= span.second;
      });
      if (!inside) outside.push_back(row);
    }
    const auto count = static_cast<double>(outside.size());
    if (outside.empty() || count < kMinShareOutside * static_cast<double>(piece.rows.size())) {
      continue;
    }
    kept_spans.emplace_back(t_ns[outside.front()], t_ns[outside.back()]);
    repair.late += piece.late;
    repair.rows.insert(repair.rows.end(), outside.begin(), outside.end());
  }
  // Repeats of a dropped clock are dropped with it; those left here lie within one piece.
  std::stable_sort(repair.rows.begin(), repair.rows.end(),
                   [&t_ns](std::size_t a, std::size_t b) { return t_ns[a] < t_ns[b]; });
  repair.repeats_dropped = repeats;
  repair.other_clock = t_ns.size() - repair.rows.size() - repeats;
  return repair;
}

std::string describe(const StampReport& report) {
  if (report.clean()) return "all stamps increase";
  return fmt::format("{} stamps go backwards (largest step back {:.1f} ms) and {} repeat",
                     report.backward, toSeconds(report.largest_back_ns) * 1e3, report.repeated);
}

std::string describe(const StampRepair& repair) {
  const std::size_t total = repair.rows.size() + repair.repeats_dropped + repair.other_clock;
  return fmt::format(
      "kept {} of {} rows ({} came late and were moved, {} repeats dropped, {} of another clock "
      "dropped; {} pieces, steps up to {:.1f} ms count as one clock)",
      repair.rows.size(), total, repair.late, repair.repeats_dropped, repair.other_clock,
      repair.pieces, toSeconds(repair.window_ns) * 1e3);
}

Result<std::vector<std::size_t>> orderRows(const std::string& path, const std::vector<TimeNs>& t_ns,
                                           const std::vector<int>& lines, bool tolerate) {
  PARKADE_CHECK(t_ns.size() == lines.size(), "{} stamps, {} lines", t_ns.size(), lines.size());
  const StampReport report = checkStamps(t_ns);
  if (report.clean()) {
    std::vector<std::size_t> rows(t_ns.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return rows;
  }
  const std::string where = fmt::format("{}:{}", path, lines[report.first_row]);
  if (!tolerate) {
    return Error{fmt::format(
        "{}: stamp {} follows {}; of {} rows {}. Repair the recording, or let the stamps be "
        "repaired by the rule in docs/formats.md (--tolerate-stamps)",
        where, t_ns[report.first_row], t_ns[report.first_row - 1], report.rows, describe(report))};
  }
  Result<StampRepair> repair = repairStamps(t_ns);
  if (!repair)
    return Error{fmt::format("{}: {}; {}", where, describe(report), repair.error().message)};
  logWarning("{}: {}; repaired: {}", path, describe(report), describe(*repair));
  return std::move(repair->rows);
}

}  // namespace parkade
