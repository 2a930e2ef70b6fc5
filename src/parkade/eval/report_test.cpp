// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "parkade/eval/test_support.hpp"

namespace parkade {
namespace {

using ::testing::HasSubstr;

Evaluation example() {
  Random random(3);
  const Trajectory reference = testing::winding(200);
  Trajectory estimate = reference;
  for (auto& pose : estimate) pose.T_world_body.translation() += testing::noise(random, 0.02);
  return *evaluate(estimate, reference);
}

TEST(Report, JsonHasTheSchema) {
  const Evaluation e = example();
  const auto json = nlohmann::json::parse(evaluationJson(e));
  for (const char* metric : {"ape", "ape_rotation_deg", "rpe"}) {
    for (const char* field : {"rmse", "mean", "median", "p95", "max"}) {
      EXPECT_TRUE(json.at(metric).at(field).is_number()) << metric << " " << field;
    }
  }
  // Every digit survives.
  EXPECT_EQ(json["ape"]["rmse"].get<double>(), e.ape.rmse);
  EXPECT_EQ(json["rpe"]["p95"].get<double>(), e.rpe.p95);
  EXPECT_EQ(json["drift_percent"].get<double>(), e.drift.percent);
  EXPECT_EQ(json["matched"], 200);
  EXPECT_EQ(json["coverage"], 1.0);
  EXPECT_EQ(json["alignment"]["method"], "se3");
}

TEST(Report, WhatIsUnknownIsNull) {
  const Trajectory parked = testing::standing(5);
  const auto json = nlohmann::json::parse(evaluationJson(*evaluate(parked, parked)));
  EXPECT_TRUE(json["rpe"]["rmse"].is_null());
  EXPECT_TRUE(json["drift_percent"].is_null());
  EXPECT_EQ(json["notes"].size(), 3u);
}

TEST(Report, TableNamesEveryFigureWithin100Columns) {
  EvaluationLabels labels;
  labels.estimate = "run/trajectory.tum";
  const std::string table = evaluationTable(example(), labels);
  for (const char* part :
       {"run/trajectory.tum (200 poses)", "coverage 100.0 %", "alignment  se3", "APE translation m",
        "APE rotation deg", "RPE translation m", "RPE over 10 m", "drift", "at the end"}) {
    EXPECT_THAT(table, HasSubstr(part));
  }
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

}  // namespace
}  // namespace parkade
