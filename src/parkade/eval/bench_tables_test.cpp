// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/bench_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace parkade {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

BenchRecord record(const std::string& route, const std::string& method, double rmse, int seed = 1) {
  BenchRecord r;
  r.garage = "paper";
  r.route = route;
  r.method = method;
  r.seed = seed;
  r.figures = {{"ape.rmse", rmse}, {"ape_aligned.rmse", 0.5 * rmse}};
  return r;
}

const std::vector<BenchMethod> kMethods = {{"vis1", "vis, one camera", false, true},
                                           {"avp-slam", "avp-slam", true, false},
                                           {"fused", "fused", true, true}};

TEST(BenchTables, PaperTablesHoldItsFiguresAndOurs) {
  std::vector<BenchRecord> records;
  for (int i = 1; i <= 5; ++i) {
    records.push_back(record("test" + std::to_string(i), "fused", 0.01 * i));
  }
  const std::vector<TextTable> tables = paperTables(records, kMethods);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_THAT(tables[0].rows[2],
              ElementsAre("Paper: Ours", "0.14", "0.19", "0.21", "0.28", "0.15", "0.19"));
  EXPECT_THAT(tables[0].rows[3],
              ElementsAre("Parkade: fused", "0.010", "0.020", "0.030", "0.040", "0.050", "0.030"));
  EXPECT_THAT(tables[0].rows[4], ElementsAre("Parkade: fused, SE(3)-aligned", "0.005", "0.010",
                                             "0.015", "0.020", "0.025", "0.015"));
  EXPECT_EQ(tables[1].rows.size(), 5u);
}

TEST(BenchTables, MeanOverSomeRoutesSaysSo) {
  BenchRecord bad = record("test2", "fused", 9.0);
  bad.failed = true;
  bad.reason = "no pose";
  const std::vector<BenchRecord> records{record("test1", "fused", 0.1), bad};
  const TextTable table = paperTables(records, kMethods)[0];
  EXPECT_THAT(table.rows[3],
              ElementsAre("Parkade: fused", "0.100", "failed", "-", "-", "-", "0.100 (1 of 5)"));
  EXPECT_THAT(plainText(detailTables(records, kMethods)[0]), HasSubstr("failed: no pose"));
}

TEST(BenchTables, SeedsGiveMeanSpreadAndWorst) {
  const std::vector<BenchRecord> records{record("test1", "vis1", 0.1, 1),
                                         record("test1", "vis1", 0.3, 2)};
  const TextTable table = paperTables(records, kMethods)[1];
  EXPECT_EQ(table.rows[3][1], "0.200 ± 0.100 (0.300)");
}

TEST(BenchTables, SweepsAndGaragesHaveTablesOfTheirOwn) {
  BenchRecord dark = record("test1", "fused", 0.4);
  dark.condition = "10 lux";
  BenchRecord other = record("random", "fused", 0.2);
  other.garage = "random 5000";
  EXPECT_THAT(paperTables({dark, other}, kMethods), IsEmpty());
  const std::vector<TextTable> tables = detailTables({dark, other}, kMethods);
  ASSERT_EQ(tables.size(), 3u);
  EXPECT_EQ(tables[0].title, "Random garages");
  EXPECT_THAT(tables[0].rows[0],
              ElementsAre("as it is", "fused", "1", "0", "0.200", "0.200", "0.200", "0.100", "-"));
  EXPECT_EQ(tables[1].rows[0][0], "10 lux");
}

TEST(BenchTables, HonestyStandsBesideItsBand) {
  std::vector<BenchRecord> records;
  for (int i = 1; i <= 5; ++i) {
    records.push_back(record("test" + std::to_string(i), "fused", 0.01));
    records.back().figures["nees.position"] = 1.0 * i;
    records.back().figures["nees.yaw"] = 1.5;
  }
  const std::vector<TextTable> tables = detailTables(records, kMethods);
  const auto found = std::find_if(tables.begin(), tables.end(), [](const TextTable& t) {
    return t.title == "Honesty of the covariances";
  });
  ASSERT_NE(found, tables.end());
  EXPECT_THAT(found->rows, ElementsAre(ElementsAre("fused", "5", "3.00", "1.25 to 5.50", "1.50",
                                                   "0.17 to 2.57")));
}

TEST(BenchTables, CamerasAreToldAndFoundByCondition) {
  std::vector<BenchRecord> records = {record("test1", "fused", 0.01),
                                      record("test2", "fused", 0.01),
                                      record("test1", "fused", 0.02), record("test3", "vis", 0.02)};
  const auto tell = [](BenchRecord& r, double told_deg, double found_m) {
    r.figures["cameras.told_deg"] = told_deg;
    r.figures["cameras.found_deg"] = 0.01;
    r.figures["cameras.told_m"] = 0.01;
    r.figures["cameras.found_m"] = found_m;
    r.figures["cameras.nees_turn"] = 2.0;
    r.figures["cameras.nees_place"] = 4.0;
  };
  tell(records[0], 0.03, 0.001);
  tell(records[1], 0.04, 0.001);
  tell(records[2], 0.1, 0.002);
  records[2].condition = "off by 0.1 deg";
  const std::vector<TextTable> tables = detailTables(records, kMethods);
  const auto found = std::find_if(tables.begin(), tables.end(), [](const TextTable& t) {
    return t.title == "Where the cameras sit";
  });
  ASSERT_NE(found, tables.end());
  EXPECT_THAT(found->rows, ElementsAre(ElementsAre("as it is", "fused", "2", "0.035", "0.010",
                                                   "10.0", "1.0", "2.00", "4.00"),
                                       ElementsAre("off by 0.1 deg", "fused", "1", "0.100", "0.010",
                                                   "10.0", "2.0", "2.00", "4.00")));
}

TEST(BenchTables, ObjectsAreSummedOverTheDrivesAsTheyAre) {
  std::vector<BenchRecord> records;
  for (int i = 1; i <= 3; ++i) {
    records.push_back(record("test" + std::to_string(i), "fused", 0.01));
    auto& figures = records.back().figures;
    const std::string arrow = "map.objects.arrow.";
    figures[arrow + "passed"] = 4.0;
    figures[arrow + "found"] = 3.0;
    figures[arrow + "told"] = 5.0;
    figures[arrow + "wrong"] = 1.0;
    figures[arrow + "texts.count"] = 3.0;
    figures[arrow + "texts.right"] = 2.0;
  }
  records[2].condition = "10 lux";
  records.push_back(record("test1", "avp-slam", 0.3));
  records.back().figures["map.objects.arrow.passed"] = 4.0;
  records.back().figures["map.objects.arrow.told"] = 0.0;
  const std::vector<TextTable> tables = detailTables(records, kMethods);
  EXPECT_EQ(tables.back().title, "Objects of the maps");
  EXPECT_THAT(tables.back().rows, ElementsAre(ElementsAre("fused", "arrow", "8", "6", "0.750", "10",
                                                          "2", "0.800", "4 of 6")));
}

TEST(BenchTables, TextsOfEveryLength) {
  const TextTable table{"T", "note", {"name", "m"}, {{"ä|b", "1.0"}, {"c"}}};
  EXPECT_EQ(plainText(table), "T\nname    m\n---------\nä|b   1.0\nc\nnote\n");
  EXPECT_EQ(markdown(table),
            "### T\n\n| name | m |\n|---|---:|\n| ä\\|b | 1.0 |\n| c |  |\n\nnote\n");
}

}  // namespace
}  // namespace parkade
