// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/bench_honesty_tables.hpp"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "parkade/eval/consistency.hpp"
#include "parkade/eval/statistics.hpp"

namespace parkade {
namespace {

// The figures of the runs of a method that did not fail.
std::vector<double> valuesOf(const std::vector<BenchRecord>& records, const std::string& method,
                             const std::string& path) {
  std::vector<double> values;
  for (const BenchRecord& record : records) {
    if (record.method != method || record.failed) continue;
    if (std::isfinite(record.figure(path))) values.push_back(record.figure(path));
  }
  return values;
}

}  // namespace

std::optional<TextTable> consistencyTable(const std::vector<BenchRecord>& records,
                                          const std::vector<BenchMethod>& methods) {
  TextTable table;
  table.title = "Honesty of the covariances";
  table.header = {"method", "runs", "NEES position", "95 % band", "NEES yaw", "95 % band"};
  for (const BenchMethod& method : methods) {
    const auto position = neesTest(valuesOf(records, method.name, "nees.position"), 3);
    const auto yaw = neesTest(valuesOf(records, method.name, "nees.yaw"), 1);
    if (!position || !yaw) continue;
    table.rows.push_back(
        {method.name, std::to_string(position->runs), figureText(position->mean, 2),
         figureText(position->lower, 2) + " to " + figureText(position->upper, 2),
         figureText(yaw->mean, 2), figureText(yaw->lower, 2) + " to " + figureText(yaw->upper, 2)});
  }
  if (table.rows.empty()) return std::nullopt;
  table.note =
      "Normalised estimation error squared, mean over each run and over the runs: above the band "
      "the covariance is too small, below it too large. Definitions: docs/evaluation.md, 6.";
  return table;
}

std::optional<TextTable> cameraTable(const std::vector<BenchRecord>& records) {
  const std::vector<std::string> figures = {"told_deg", "found_deg", "told_m",
                                            "found_m",  "nees_turn", "nees_place"};
  std::map<std::pair<std::string, std::string>, std::map<std::string, std::vector<double>>> rows;
  for (const BenchRecord& record : records) {
    if (record.failed || !std::isfinite(record.figure("cameras.found_deg"))) continue;
    for (const std::string& figure : figures) {
      rows[{record.condition, record.method}][figure].push_back(record.figure("cameras." + figure));
    }
  }
  if (rows.empty()) return std::nullopt;
  TextTable table;
  table.title = "Where the cameras sit";
  table.header = {"condition", "method",   "runs",      "told deg",  "found deg",
                  "told mm",   "found mm", "NEES turn", "NEES place"};
  for (const auto& [row, values] : rows) {
    const auto& [condition, method] = row;
    const auto rms = [&values = values](const char* name, double unit, int decimals) {
      return figureText(unit * describe(values.at(name)).rmse, decimals);
    };
    const auto mean = [&values = values](const char* name) {
      return figureText(describe(values.at(name)).mean, 2);
    };
    table.rows.push_back({condition.empty() ? "as it is" : condition, method,
                          std::to_string(values.at("found_deg").size()), rms("told_deg", 1.0, 3),
                          rms("found_deg", 1.0, 3), rms("told_m", 1e3, 1), rms("found_m", 1e3, 1),
                          mean("nees_turn"), mean("nees_place")});
  }
  table.note =
      "Errors of the cameras' turns about, and places along, each axis (RMS over axes, cameras and "
      "runs): as told before the drive, and as found by its end. NEES: 3 where what is told of "
      "them "
      "is honest.";
  return table;
}

}  // namespace parkade
