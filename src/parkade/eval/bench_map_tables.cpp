// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/bench_map_tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace parkade {
namespace {

struct Counts {
  double passed = 0.0;
  double found = 0.0;
  double told = 0.0;
  double wrong = 0.0;
  double texts = 0.0;
  double texts_right = 0.0;
};

// "map.objects.CLASS.FIGURE" of one record, added up.
void add(const BenchRecord& record, std::map<std::string, Counts>& classes) {
  const std::string before = "map.objects.";
  for (const std::string& name : record.namesBetween(before, ".passed")) {
    const std::string stem = before + name;
    Counts& counts = classes[name];
    counts.passed += record.figure(stem + ".passed");
    counts.found += record.figure(stem + ".found");
    counts.told += record.figure(stem + ".told");
    counts.wrong += record.figure(stem + ".wrong");
    counts.texts += record.figure(stem + ".texts.count");
    counts.texts_right += record.figure(stem + ".texts.right");
  }
}

std::string ratio(double part, double whole) {
  return figureText(whole > 0.0 ? part / whole : std::nan(""));
}

}  // namespace

std::optional<TextTable> objectTable(const std::vector<BenchRecord>& records,
                                     const std::vector<BenchMethod>& methods) {
  TextTable table;
  table.title = "Objects of the maps";
  table.header = {"method", "class", "passed",    "found",      "recall",
                  "told",   "wrong", "precision", "texts right"};
  for (const BenchMethod& method : methods) {
    std::map<std::string, Counts> classes;
    for (const BenchRecord& record : records) {
      const bool counts = record.method == method.name && record.condition.empty();
      if (counts && !record.failed) add(record, classes);
    }
    const bool any = std::any_of(classes.begin(), classes.end(),
                                 [](const auto& entry) { return entry.second.told > 0.0; });
    if (!any) continue;  // a method whose maps hold no objects
    for (const auto& [name, c] : classes) {
      table.rows.push_back(
          {method.name, name, figureText(c.passed, 0), figureText(c.found, 0),
           ratio(c.found, c.passed), figureText(c.told, 0), figureText(c.wrong, 0),
           ratio(c.told - c.wrong, c.told),
           c.texts > 0.0 ? fmt::format("{:.0f} of {:.0f}", c.texts_right, c.texts) : "-"});
    }
  }
  if (table.rows.empty()) return std::nullopt;
  table.note =
      "Sums over the drives as they are. Passed within 8 m, whatever stands between; found within "
      "1 m, of those passed; wrong, of those told near the way; texts of those found that bear "
      "one.";
  return table;
}

}  // namespace parkade
