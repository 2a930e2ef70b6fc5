// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/bench_plan.hpp"

#include <gmock/gmock.h>

#include <map>

#include "parkade/cli/semantic_garages.hpp"

namespace parkade::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

PaperBenchOptions twoRoutes() {
  PaperBenchOptions options;
  options.out = "out";
  options.routes = "test1,test2";
  return options;
}

TEST(BenchPlan, SemanticWithAllCamerasNamesThem) {
  PaperBenchOptions options = twoRoutes();
  options.methods = "vis,vis1,semantic,semantic-all";
  options.variants = {"own=semantic"};
  const Result<BenchPlan> plan = planBench(options);
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  std::map<std::string, std::string> cameras;
  for (const BenchVariant& variant : plan->variants) {
    cameras[variant.method.name] = camerasOption(variant, {"cam0", "cam1", "cam2"});
  }
  EXPECT_EQ(cameras["vis"], "");
  EXPECT_EQ(cameras["vis1"], "cam0");
  EXPECT_EQ(cameras["semantic"], "cam0");
  EXPECT_EQ(cameras["own"], "cam0");
  EXPECT_EQ(cameras["semantic-all"], "cam0,cam1,cam2");
}

TEST(BenchPlan, SettingOfDrawingIsToldOfDrawnDrivesAlone) {
  PaperBenchOptions options = twoRoutes();
  options.sequences = "DIR";
  options.fast = true;
  options.duration_s = 3.0;
  const Result<BenchPlan> plan = planBench(options);
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  EXPECT_THAT(settingText(options, *plan, {}),
              AllOf(HasSubstr("one sample a pixel"), HasSubstr("Every drive was cut after 3 s"),
                    Not(HasSubstr("DIR"))));
  EXPECT_THAT(settingText(options, *plan, {"test1"}),
              AllOf(HasSubstr("Recordings in DIR were used as they are for test1."),
                    HasSubstr("Others were drawn with one sample a pixel. Each of these was cut")));
  EXPECT_THAT(
      settingText(options, *plan, {"test1", "test2"}),
      AllOf(HasSubstr("for test1, test2."), Not(HasSubstr("sample")), Not(HasSubstr("cut after"))));
}

TEST(SemanticGarages, RangesHaveALimit) {
  EXPECT_THAT(*parseGarages("random:3"), testing::ElementsAre(5000, 5001, 5002));
  EXPECT_THAT(*parseGarages("random:7-8"), testing::ElementsAre(7, 8));
  EXPECT_EQ(parseGarages("random:0-99999")->size(), 100'000u);
  for (const char* text : {"random:0-100000", "random:100001", "random:2147483647",
                           "random:0-2147483647", "random:2147483647-2147483647"}) {
    const Result<std::vector<int>> seeds = parseGarages(text);
    ASSERT_FALSE(seeds.ok()) << text;
    EXPECT_THAT(seeds.error().message, AllOf(HasSubstr(text), HasSubstr("at most 100000 garages")));
  }
}

}  // namespace
}  // namespace parkade::cli
