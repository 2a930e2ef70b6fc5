// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/run_outputs.hpp"

#include <gmock/gmock.h>

#include "parkade/io/sequence_test_support.hpp"

namespace parkade::cli {
namespace {

TEST(RunOutputs, TextsHoldPathsThatAreNoUtf8) {
  const Rig rig = test::smallRig();
  const auto run = MappingRun::create(rig, PipelineOptions{}, 1, RunMethod::kVis);
  ASSERT_TRUE(run.ok()) << run.error().message;
  RunDescription description;
  description.rig = rig;
  description.source = "drive\xFF";
  const RunTexts texts = runTexts(description, **run, HealthLog());
  ASSERT_EQ(texts.size(), 3u);
  EXPECT_EQ(texts[2].first, "metrics.json");
  EXPECT_THAT(texts[2].second, testing::HasSubstr("drive\xEF\xBF\xBD"));
}

}  // namespace
}  // namespace parkade::cli
