// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/bench_tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>

#include "parkade/eval/bench_honesty_tables.hpp"
#include "parkade/eval/bench_map_tables.hpp"
#include "parkade/eval/statistics.hpp"

namespace parkade {
namespace {

using Records = std::vector<const BenchRecord*>;
using Row = std::vector<std::string>;

constexpr std::array<const char*, 5> kPaperRoutes = {"test1", "test2", "test3", "test4", "test5"};
constexpr const char* kAnchored = "ape.rmse";
constexpr const char* kAligned = "ape_aligned.rmse";

Records select(const std::vector<BenchRecord>& records,
               const std::function<bool(const BenchRecord&)>& wanted) {
  Records chosen;
  for (const BenchRecord& record : records) {
    if (wanted(record)) chosen.push_back(&record);
  }
  return chosen;
}

bool ofPaper(const BenchRecord& record) {
  return record.garage == "paper" && record.condition.empty();
}

// The figures of those that did not fail.
std::vector<double> valuesOf(const Records& records, const std::string& path) {
  std::vector<double> values;
  for (const BenchRecord* record : records) {
    const double value = record->failed ? std::nan("") : record->figure(path);
    if (!std::isnan(value)) values.push_back(value);
  }
  return values;
}

// One drive's cell over its seeds.
std::string cellText(const Records& records, const std::string& path) {
  if (records.empty()) return "-";
  const Statistics s = describe(valuesOf(records, path));
  if (s.count == 0) return "failed";
  std::string text = figureText(s.mean);
  if (s.count > 1) text += fmt::format(" ± {:.3f} ({:.3f})", s.std, s.max);
  if (s.count < records.size()) {
    text += fmt::format(", {} failed", records.size() - s.count);
  }
  return text;
}

// A method's row of Table 2 or 3: five routes and their mean.
Row paperRow(const std::vector<BenchRecord>& records, const BenchMethod& method,
             const std::string& path, const std::string& label) {
  Row row{label};
  std::vector<double> means;
  for (const char* route : kPaperRoutes) {
    const Records of_route = select(records, [&](const BenchRecord& r) {
      return ofPaper(r) && r.route == route && r.method == method.name;
    });
    row.push_back(cellText(of_route, path));
    const Statistics s = describe(valuesOf(of_route, path));
    if (s.count > 0) means.push_back(s.mean);
  }
  std::string mean = figureText(describe(means).mean);
  if (!means.empty() && means.size() < kPaperRoutes.size()) {
    mean += fmt::format(" ({} of 5)", means.size());
  }
  row.push_back(mean);
  return row;
}

TextTable paperTable(const std::string& title, std::vector<Row> published,
                     const std::vector<BenchRecord>& records,
                     const std::vector<BenchMethod>& methods) {
  TextTable table;
  table.title = title;
  table.header = {"Method", "Test1", "Test2", "Test3", "Test4", "Test5", "Avg."};
  table.rows = std::move(published);
  for (const auto& [path, suffix] :
       {std::pair(kAnchored, ""), std::pair(kAligned, ", SE(3)-aligned")}) {
    for (const BenchMethod& method : methods) {
      table.rows.push_back(paperRow(records, method, path, "Parkade: " + method.label + suffix));
    }
  }
  table.note =
      "Position RMSE, m. Parkade's rows: measured on its own simulated garage; the first pose is "
      "joined with the truth's, unless SE(3)-aligned. The paper's rows: as published, on its own "
      "CARLA garage and routes, which are not public. Several seeds: mean ± standard deviation "
      "(worst). '-': not run.";
  return table;
}

std::vector<BenchMethod> presentMethods(const std::vector<BenchRecord>& records,
                                        const std::vector<BenchMethod>& methods) {
  std::vector<BenchMethod> present;
  for (const BenchMethod& method : methods) {
    const bool any = std::any_of(records.begin(), records.end(),
                                 [&](const BenchRecord& r) { return r.method == method.name; });
    if (any) present.push_back(method);
  }
  return present;
}

std::vector<BenchMethod> onlyThose(const std::vector<BenchMethod>& methods,
                                   bool BenchMethod::*kind) {
  std::vector<BenchMethod> chosen;
  for (const BenchMethod& method : methods) {
    if (method.*kind) chosen.push_back(method);
  }
  return chosen;
}

std::string driveName(const BenchRecord& record, bool with_seed) {
  std::string name = record.garage == "paper" ? record.route : record.garage;
  if (!record.condition.empty()) name += ", " + record.condition;
  if (with_seed) name += fmt::format(", seed {}", record.seed);
  return name;
}

bool severalSeeds(const std::vector<BenchRecord>& records) {
  return std::any_of(records.begin(), records.end(), [&](const BenchRecord& r) {
    return r.seed != records.front().seed && r.garage == "paper";
  });
}

struct Column {
  const char* name;
  const char* path;
  int decimals;
  double factor;
};

TextTable perRun(const std::string& title, const std::vector<BenchRecord>& records,
                 const std::vector<Column>& columns) {
  TextTable table;
  table.title = title;
  table.header = {"drive", "method"};
  for (const Column& column : columns) table.header.emplace_back(column.name);
  const bool with_seed = severalSeeds(records);
  for (const BenchRecord& record : records) {
    Row row{driveName(record, with_seed), record.method};
    for (const Column& column : columns) {
      const double value = record.failed ? std::nan("") : record.figure(column.path);
      row.push_back(figureText(column.factor * value, column.decimals));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable accuracyTable(const std::vector<BenchRecord>& records) {
  TextTable table = perRun("Accuracy of every run", records,
                           {{"RMSE m", kAnchored, 3, 1.0},
                            {"aligned m", kAligned, 3, 1.0},
                            {"largest m", "ape.max", 3, 1.0},
                            {"at the end m", "final_error_m", 3, 1.0},
                            {"heading deg", "ape_heading_deg.rmse", 3, 1.0},
                            {"RPE 10 m", "rpe.rmse", 3, 1.0},
                            {"coverage %", "coverage", 1, 100.0},
                            {"path m", "path_m", 0, 1.0}});
  if (std::any_of(records.begin(), records.end(), [](const BenchRecord& r) { return r.failed; })) {
    table.header.emplace_back("remark");
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (records[i].failed) table.rows[i].push_back("failed: " + records[i].reason);
    }
  }
  table.note =
      "First pose joined with the truth's, unless aligned (SE(3)). Definitions: "
      "docs/evaluation.md.";
  return table;
}

std::vector<std::string> stageNames(const std::vector<BenchRecord>& records) {
  std::vector<std::string> names;
  for (const BenchRecord& record : records) {
    for (const std::string& name : record.namesBetween("timing.stages.", ".mean_ms")) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

std::optional<TextTable> timingTable(const std::vector<BenchRecord>& records) {
  std::vector<BenchRecord> timed;
  for (const BenchRecord& record : records) {
    if (record.figures.count("timing.real_time_factor") > 0) timed.push_back(record);
  }
  if (timed.empty()) return std::nullopt;
  TextTable table = perRun("Time and memory of every run", timed,
                           {{"real-time factor", "timing.real_time_factor", 2, 1.0},
                            {"memory MB", "timing.peak_memory_mb", 0, 1.0}});
  const std::vector<std::string> stages = stageNames(timed);
  for (const std::string& stage : stages) {
    table.header.push_back(stage + " ms");
    for (std::size_t i = 0; i < timed.size(); ++i) {
      if (timed[i].failed) continue;
      table.rows[i].push_back(
          figureText(timed[i].figure(fmt::format("timing.stages.{}.mean_ms", stage)), 1));
    }
  }
  table.note =
      "Real-time factor: processing time / recorded time; below 1 is faster than real time. "
      "Stages: "
      "mean time of a call.";
  return table;
}

std::optional<TextTable> mapTable(const std::vector<BenchRecord>& records) {
  std::vector<BenchRecord> mapped;
  for (const BenchRecord& record : records) {
    if (record.figures.count("map.slots.passed") > 0) mapped.push_back(record);
  }
  if (mapped.empty()) return std::nullopt;
  TextTable table = perRun("Maps", mapped,
                           {{"slots passed", "map.slots.passed", 0, 1.0},
                            {"recall", "map.slots.recall", 3, 1.0},
                            {"in sight", "map.slots.recall_in_sight", 3, 1.0},
                            {"precision", "map.slots.precision", 3, 1.0},
                            {"duplicates", "map.slots.duplicates", 0, 1.0},
                            {"corner m", "map.slots.entrance_error_m.median", 3, 1.0},
                            {"corner p95 m", "map.slots.entrance_error_m.p95", 3, 1.0},
                            {"availability", "map.slots.availability.accuracy", 3, 1.0},
                            {"numbers", "map.slots.numbers.count", 0, 1.0},
                            {"read rightly", "map.slots.numbers.right", 0, 1.0},
                            {"wrongly", "map.slots.numbers.wrong", 0, 1.0},
                            {"lines IoU", "map.layers.parking_lines.tolerant_iou", 3, 1.0},
                            {"markers IoU", "map.layers.road_markers.tolerant_iou", 3, 1.0},
                            {"loops", "map.loops.told", 0, 1.0},
                            {"wrong", "map.loops.wrong", 0, 1.0}});
  table.note =
      "Slots passed within 8 m; in sight: recall of those of which the map has seen both entrance "
      "corners' floor; corner: entrance corners, median and p95; availability: share of "
      "found slots told rightly; numbers: found slots that have one painted; IoU within a cell of "
      "5 cm; loop closures, and those that are wrong.";
  return table;
}

// A row per method and condition (or for all random garages): what a reader wants of many drives.
std::optional<TextTable> summaryTable(const std::string& title,
                                      const std::vector<BenchRecord>& records,
                                      const std::vector<BenchMethod>& methods,
                                      const std::function<bool(const BenchRecord&)>& wanted) {
  std::vector<std::string> conditions;
  for (const BenchRecord& record : records) {
    if (!wanted(record)) continue;
    if (std::find(conditions.begin(), conditions.end(), record.condition) == conditions.end()) {
      conditions.push_back(record.condition);
    }
  }
  if (conditions.empty()) return std::nullopt;
  TextTable table;
  table.title = title;
  table.header = {"condition", "method",  "runs",           "failed",     "mean m",
                  "median m",  "worst m", "aligned mean m", "heading deg"};
  for (const std::string& condition : conditions) {
    for (const BenchMethod& method : methods) {
      const Records chosen = select(records, [&](const BenchRecord& r) {
        return wanted(r) && r.condition == condition && r.method == method.name;
      });
      if (chosen.empty()) continue;
      const Statistics s = describe(valuesOf(chosen, kAnchored));
      table.rows.push_back({condition.empty() ? "as it is" : condition, method.name,
                            std::to_string(chosen.size()), std::to_string(chosen.size() - s.count),
                            figureText(s.mean), figureText(s.median), figureText(s.max),
                            figureText(describe(valuesOf(chosen, kAligned)).mean),
                            figureText(describe(valuesOf(chosen, "ape_heading_deg.rmse")).mean)});
    }
  }
  table.note =
      "Position RMSE of each run, m, first pose joined with the truth's: mean, median and worst "
      "over "
      "the runs that did not fail.";
  return table;
}

}  // namespace

double BenchRecord::figure(const std::string& path) const {
  const auto found = figures.find(path);
  return found == figures.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::vector<std::string> BenchRecord::namesBetween(const std::string& before,
                                                   const std::string& after) const {
  std::vector<std::string> names;
  for (const auto& [path, value] : figures) {
    if (!path.starts_with(before) || !path.ends_with(after)) continue;
    names.push_back(path.substr(before.size(), path.size() - before.size() - after.size()));
  }
  return names;
}

std::string figureText(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

std::vector<TextTable> paperTables(const std::vector<BenchRecord>& records,
                                   const std::vector<BenchMethod>& methods) {
  if (std::none_of(records.begin(), records.end(), ofPaper)) return {};
  const std::vector<BenchMethod> present = presentMethods(records, methods);
  const Row ours{"Paper: Ours", "0.14", "0.19", "0.21", "0.28", "0.15", "0.19"};
  return {paperTable("Table 2: whole systems",
                     {{"Paper: ORB-SLAM3", "0.66", "2.78", "0.46", "0.58", "0.44", "0.98"},
                      {"Paper: AVP-SLAM", "0.35", "0.39", "0.24", "0.40", "0.68", "0.41"},
                      ours},
                     records, onlyThose(present, &BenchMethod::system)),
          paperTable("Table 3: parts of the system",
                     {{"Paper: Ours(VIS)", "0.93", "0.74", "0.78", "2.21", "1.36", "1.20"},
                      {"Paper: Ours(Semantic)", "0.37", "0.40", "0.25", "0.44", "0.69", "0.43"},
                      {"Paper: Ours(Fused)", "0.14", "0.19", "0.21", "0.28", "0.15", "0.19"}},
                     records, onlyThose(present, &BenchMethod::ablation))};
}

std::vector<TextTable> detailTables(const std::vector<BenchRecord>& records,
                                    const std::vector<BenchMethod>& methods) {
  std::vector<TextTable> tables;
  if (records.empty()) return tables;
  const std::vector<BenchMethod> present = presentMethods(records, methods);
  const auto add = [&tables](std::optional<TextTable> table) {
    if (table) tables.push_back(std::move(*table));
  };
  add(summaryTable("Random garages", records, present,
                   [](const BenchRecord& r) { return r.garage != "paper"; }));
  const bool swept = std::any_of(records.begin(), records.end(), [](const BenchRecord& r) {
    return r.garage == "paper" && !r.condition.empty();
  });
  if (swept) {
    add(summaryTable("Garage 'paper' under other conditions", records, present,
                     [](const BenchRecord& r) { return r.garage == "paper"; }));
  }
  tables.push_back(accuracyTable(records));
  add(consistencyTable(records, present));
  add(cameraTable(records));
  add(timingTable(records));
  add(mapTable(records));
  add(objectTable(records, present));
  return tables;
}

}  // namespace parkade
