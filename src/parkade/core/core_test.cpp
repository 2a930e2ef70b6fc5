// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "parkade/core/check.hpp"
#include "parkade/core/log.hpp"
#include "parkade/core/markup.hpp"
#include "parkade/core/random.hpp"
#include "parkade/core/result.hpp"
#include "parkade/core/split.hpp"
#include "parkade/core/time.hpp"

namespace parkade {
namespace {

using ::testing::HasSubstr;

TEST(Check, MessageNamesConditionAndValues) {
  const int n = 1;
  try {
    PARKADE_CHECK(n > 1, "window of {} keyframes", n);
    FAIL() << "did not throw";
  } catch (const CheckError& error) {
    EXPECT_THAT(error.what(), HasSubstr("n > 1"));
    EXPECT_THAT(error.what(), HasSubstr("window of 1 keyframes"));
    EXPECT_THAT(error.what(), HasSubstr("core_test.cpp"));
  }
  EXPECT_NO_THROW(PARKADE_CHECK(true));
}

TEST(Result, HoldsValueOrError) {
  const Result<std::string> good = std::string("yes");
  EXPECT_TRUE(good);
  EXPECT_EQ(*good, "yes");
  const Result<std::string> bad = Error{"file.csv:3: no number"};
  EXPECT_FALSE(bad);
  EXPECT_EQ(bad.error().message, "file.csv:3: no number");
  EXPECT_THROW(static_cast<void>(bad.value()), CheckError);
  EXPECT_TRUE(Status());
  EXPECT_FALSE(Status(Error{"full disk"}));
}

TEST(Time, ConvertsBothWays) {
  EXPECT_EQ(fromSeconds(1.5), 1'500'000'000);
  EXPECT_EQ(fromSeconds(-0.1), -100'000'000);
  EXPECT_DOUBLE_EQ(toSeconds(-250'000'000), -0.25);
  // What no integer holds stays on its side.
  EXPECT_GT(fromSeconds(1e300), 0);
  EXPECT_LT(fromSeconds(-1e300), 0);
  EXPECT_EQ(fromSeconds(std::nan("")), 0);
}

TEST(Split, LeavesEmptyPartsOutAndTellsThem) {
  EXPECT_THAT(split("front,rear", ','), ::testing::ElementsAre("front", "rear"));
  EXPECT_THAT(split(",front,,rear,", ','), ::testing::ElementsAre("front", "rear"));
  for (const char* whole : {"front", "front,rear"}) EXPECT_FALSE(hasEmptyPart(whole, ',')) << whole;
  for (const char* holed : {"", ",", "front,", ",front", "front,,rear"}) {
    EXPECT_TRUE(hasEmptyPart(holed, ',')) << holed;
  }
}

TEST(Log, GoesThroughTheOneSink) {
  std::vector<std::string> seen;
  setLogSink([&](LogLevel level, std::string_view message) {
    if (level == LogLevel::kWarning) seen.emplace_back(message);
  });
  logWarning("camera {} is dark", 3);
  logInfo("not a warning");
  setLogSink({});
  logWarning("nobody listens");
  EXPECT_EQ(seen, std::vector<std::string>{"camera 3 is dark"});
}

TEST(Random, SameSeedSameNumbers) {
  Random a(42);
  Random b(42);
  Random c(43);
  int equal = 0;
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t bits = a.bits();
    EXPECT_EQ(bits, b.bits());
    equal += bits == c.bits() ? 1 : 0;
  }
  EXPECT_EQ(equal, 0);
}

TEST(Random, KnownNumbersStayAsTheyAre) {
  // Recorded sequences depend on these: a change breaks "same seed, same bytes" between versions.
  Random random(1);
  EXPECT_EQ(random.bits(), 14971601782005023387ULL);
  EXPECT_EQ(random.bits(), 13781649495232077965ULL);
}

TEST(Random, ForkDependsOnNameNotOnDraws) {
  Random a(42);
  static_cast<void>(a.bits());
  EXPECT_EQ(a.fork("imu").bits(), Random(42).fork("imu").bits());
  EXPECT_NE(a.fork("imu").bits(), a.fork("wheel").bits());
  EXPECT_NE(a.fork("imu", 0).bits(), a.fork("imu", 1).bits());
}

TEST(Random, MomentsOfTheDistributions) {
  Random random(7);
  constexpr int kCount = 200'000;
  double sum = 0.0;
  double sum2 = 0.0;
  double sum4 = 0.0;
  double uniform_sum = 0.0;
  std::vector<int> bins(6, 0);
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
    uniform_sum += random.uniform(2.0, 4.0);
    ++bins[static_cast<std::size_t>(random.integer(0, 5))];
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(sum2 / kCount, 1.0, 0.015);
  EXPECT_NEAR(sum4 / kCount, 3.0, 0.1);
  EXPECT_NEAR(uniform_sum / kCount, 3.0, 0.01);
  for (const int bin : bins) EXPECT_NEAR(bin, kCount / 6.0, 800.0);
  EXPECT_THROW(static_cast<void>(random.index(0)), CheckError);
  EXPECT_THROW(static_cast<void>(random.integer(2, 1)), CheckError);
}

TEST(Markup, NothingOfATextIsTakenForATag) {
  EXPECT_EQ(escapedMarkup("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
  EXPECT_EQ(escapedMarkup("two\nlines\x01"), "two lines ");
  EXPECT_EQ(escapedMarkup("Stra\xc3\x9f"
                          "e"),
            "Stra\xc3\x9f"
            "e");
}

}  // namespace
}  // namespace parkade
