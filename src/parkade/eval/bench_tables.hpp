// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "parkade/eval/text_table.hpp"

namespace parkade {

/// One run of one method over one drive, judged.
struct BenchRecord {
  std::string garage;     ///< "paper", or "random 5003"
  std::string route;      ///< "test1"
  std::string condition;  ///< what differs from the route as it is, "10 lux"; empty: nothing
  std::string method;
  int seed = 1;
  bool failed = false;
  std::string reason;  ///< of a failure
  /// By path: "ape.rmse" (m, first pose anchored), "ape_aligned.rmse" (m, SE(3)),
  /// "ape_heading_deg.rmse", "rpe.rmse", "final_error_m", "coverage", "path_m",
  /// "timing.real_time_factor", "timing.peak_memory_mb", "timing.stages.NAME.mean_ms",
  /// "map.slots.recall", ... What is not known is not there.
  std::map<std::string, double> figures;

  /// NaN where unknown.
  [[nodiscard]] double figure(const std::string& path) const;
  /// What stands between `before` and `after` in the paths that begin and end so.
  [[nodiscard]] std::vector<std::string> namesBetween(const std::string& before,
                                                      const std::string& after) const;
};

/// A method's place in the tables.
struct BenchMethod {
  std::string name;
  std::string label;      ///< for people
  bool system = false;    ///< a row of the paper's Table 2: whole systems
  bool ablation = false;  ///< a row of the paper's Table 3: parts of the system
};

/// Tables 2 and 3 of the paper (position RMSE, m) with its figures above those measured: first pose
/// anchored, and SE(3)-aligned. Of several seeds: mean, standard deviation, worst. A mean over less
/// than all five routes says so. Only where a drive of the garage paper is among the records.
std::vector<TextTable> paperTables(const std::vector<BenchRecord>& records,
                                   const std::vector<BenchMethod>& methods);

/// Accuracy, timing and map scores of every run, and summaries over other garages and conditions;
/// tables that would be empty are left out. A failed run is a row that says why.
std::vector<TextTable> detailTables(const std::vector<BenchRecord>& records,
                                    const std::vector<BenchMethod>& methods);

/// "0.034", "-" where NaN.
std::string figureText(double value, int decimals = 3);

}  // namespace parkade
