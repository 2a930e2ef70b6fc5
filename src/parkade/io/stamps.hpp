// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/core/time.hpp"

namespace parkade {

/// How far the stamps of a file are from increasing strictly.
struct StampReport {
  std::size_t rows = 0;
  std::size_t backward = 0;    ///< rows whose stamp is smaller than that of the row above
  std::size_t repeated = 0;    ///< rows whose stamp is that of the row above
  std::size_t first_row = 0;   ///< the first such row, counts from 0
  TimeNs largest_back_ns = 0;  ///< largest step back, as a positive number
  [[nodiscard]] bool clean() const { return backward == 0 && repeated == 0; }
};

StampReport checkStamps(const std::vector<TimeNs>& t_ns);

/// The rows that make a strictly increasing series of one clock.
struct StampRepair {
  std::vector<std::size_t> rows;    ///< kept rows in the order of time
  std::size_t late = 0;             ///< kept rows that were moved before a row above them
  std::size_t repeats_dropped = 0;  ///< rows of a stamp that an earlier row has
  std::size_t other_clock = 0;      ///< rows dropped because their clock is another one
  std::size_t pieces = 0;           ///< pieces that the file falls into; 1: one clock throughout
  TimeNs window_ns = 0;             ///< largest step that counts as the same clock
};

/// Repairs stamps by the rule of docs/formats.md, "Repairing stamps":
/// 1. A row belongs to a piece where its stamp is at most ten sample periods from that piece's
///    newest stamp (the nearest piece wins), otherwise it opens a piece. The period is the median
///    step of the sorted stamps. So rows that came late go back into their place, and rows of
///    another clock, which no sorting can place, stay apart.
/// 2. Of rows with one stamp the first in the file is kept.
/// 3. The longest piece (in time) is kept. Another piece is kept, longest first, where at least
/// nine
///    tenths of its rows lie outside the time kept so far, and then only those rows. Pieces of less
///    than three rows are dropped.
/// Fails where the stamps fall into more than 1000 pieces: there is no order to recover.
Result<StampRepair> repairStamps(const std::vector<TimeNs>& t_ns);

/// "10488 stamps go backwards (the largest step back is 357.3 ms) and 4 repeat"
std::string describe(const StampReport& report);
/// "kept 11345 of 36576 rows: 0 were late, ..."
std::string describe(const StampRepair& repair);

/// The strict and the tolerant way in one: rows in the order of time. An Error where the stamps are
/// not clean and `tolerate` is false; it names file, first line, counts and what to do. With
/// `tolerate` the repair is logged as a warning. lines: the line of each row in the file.
Result<std::vector<std::size_t>> orderRows(const std::string& path, const std::vector<TimeNs>& t_ns,
                                           const std::vector<int>& lines, bool tolerate);

}  // namespace parkade
