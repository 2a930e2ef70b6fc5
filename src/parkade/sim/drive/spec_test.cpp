// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/spec.hpp"

#include <gtest/gtest.h>

namespace parkade::sim {
namespace {

TEST(SimSpec, TakesTheRoutesConditionsAndTheUsersChanges) {
  const Result<SimSpec> spec =
      parseSimAddress("sim:paper/test4?seed=3&lux=50&rig=nuscenes6&fast=1&images=0&duration=20");
  ASSERT_TRUE(spec.ok()) << spec.error().message;
  EXPECT_EQ(spec->garage, "paper");
  EXPECT_EQ(spec->route, "test4");
  EXPECT_EQ(spec->seed, 3);
  EXPECT_EQ(spec->lux, 50.0);
  EXPECT_EQ(spec->occupancy, 0.20);  // the route's own
  EXPECT_EQ(spec->rig, "nuscenes6");
  EXPECT_TRUE(spec->fast);
  EXPECT_FALSE(spec->images);
  EXPECT_EQ(spec->duration, 20.0);
  EXPECT_EQ(spec->name(), "sim:paper/test4");
}

TEST(SimSpec, AGarageAloneHasARoute) {
  EXPECT_EQ(parseSimAddress("sim:paper")->route, "test1");
  EXPECT_EQ(parseSimAddress("sim:random?garage_seed=4")->route, "random");
}

TEST(SimSpec, ParkedCarsAreTheGaragesUnlessTheyHaveASeedOfTheirOwn) {
  EXPECT_EQ(parseSimAddress("sim:random?garage_seed=4")->parkedSeed(), 4);
  EXPECT_EQ(parseSimAddress("sim:random?garage_seed=4&parked_seed=0")->parkedSeed(), 0);
}

std::string messageOf(const std::string& address) {
  const Result<SimSpec> spec = parseSimAddress(address);
  return spec.ok() ? "no error" : spec.error().message;
}

TEST(SimSpec, SaysWhatIsWrongAndWhatIsKnown) {
  EXPECT_EQ(messageOf("sim:paper/test1?lux=0"),
            "sim:paper/test1?lux=0: lux: expected 1 to 5000 (lx), found '0'");
  EXPECT_NE(
      messageOf("sim:paper/test9").find("known are test1, test2, test3, test4, test5, random"),
      std::string::npos);
  EXPECT_NE(messageOf("sim:moon/test1").find("garage 'moon' is unknown"), std::string::npos);
  EXPECT_NE(messageOf("sim:random/test1").find("route 'test1' is unknown in garage random"),
            std::string::npos);
  EXPECT_NE(messageOf("sim:paper/test1?luxx=3").find("unknown option 'luxx'"), std::string::npos);
  EXPECT_NE(messageOf("sim:paper/test1?lux").find("expected name=value"), std::string::npos);
  EXPECT_NE(messageOf("sim:paper/test1?seed=x").find("expected a whole number"), std::string::npos);
  EXPECT_NE(messageOf("sim:paper/test1?parked_seed=-2").find("parked_seed"), std::string::npos);
  EXPECT_NE(messageOf("sim:paper/test1?duration=0.1").find("at least 1 s"), std::string::npos);
  EXPECT_NE(messageOf("bag.mcap").find("no simulator address"), std::string::npos);
}

TEST(SimSpec, DumpReadsBack) {
  SimSpec spec = *parseSimAddress("sim:paper/test5?seed=12&calib_error_deg=0.3");
  const std::string text = dumpOptions(asOptions(spec));
  EXPECT_NE(text.find("calib_error_deg: 0.3"), std::string::npos);
  EXPECT_NE(text.find("lux: 10"), std::string::npos);
}

}  // namespace
}  // namespace parkade::sim
