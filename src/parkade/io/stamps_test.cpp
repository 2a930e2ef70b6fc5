// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/stamps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "parkade/core/random.hpp"
#include "parkade/io/sequence_files.hpp"
#include "parkade/io/test_support.hpp"

namespace parkade {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<TimeNs> every(TimeNs period_ms, TimeNs begin_ms, TimeNs end_ms) {
  std::vector<TimeNs> t_ns;
  for (TimeNs t = begin_ms; t < end_ms; t += period_ms) t_ns.push_back(t * kNsPerMs);
  return t_ns;
}

std::vector<TimeNs> pick(const std::vector<TimeNs>& t_ns, const std::vector<std::size_t>& rows) {
  std::vector<TimeNs> picked;
  for (const std::size_t row : rows) picked.push_back(t_ns[row]);
  return picked;
}

TEST(Stamps, CountsStepsBackAndRepeats) {
  const StampReport report = checkStamps({10, 20, 20, 15, 30, 30, 5, 40});
  EXPECT_EQ(report.rows, 8u);
  EXPECT_EQ(report.backward, 2u);
  EXPECT_EQ(report.repeated, 2u);
  EXPECT_EQ(report.first_row, 2u);
  EXPECT_EQ(report.largest_back_ns, 25);
  EXPECT_TRUE(checkStamps({1, 2, 3}).clean());
  EXPECT_TRUE(checkStamps({}).clean());
}

TEST(Stamps, RefusesWithFirstLineCountsAndAdvice) {
  const auto rows = orderRows("imu.csv", {10, 20, 15, 15}, {2, 3, 4, 5}, false);
  ASSERT_FALSE(rows.ok());
  EXPECT_THAT(rows.error().message,
              AllOf(HasSubstr("imu.csv:4: stamp 15 follows 20"), HasSubstr("of 4 rows"),
                    HasSubstr("1 stamps go backwards"), HasSubstr("1 repeat"),
                    HasSubstr("--tolerate-stamps")));
}

TEST(Stamps, RowsThatCameLateGoBackIntoTheirPlace) {
  std::vector<TimeNs> t_ns = every(5, 0, 1000);
  std::swap(t_ns[50], t_ns[51]);
  std::swap(t_ns[80], t_ns[83]);
  const auto repair = repairStamps(t_ns);
  ASSERT_TRUE(repair.ok());
  EXPECT_EQ(pick(t_ns, repair->rows), every(5, 0, 1000));
  EXPECT_EQ(repair->pieces, 1u);
  EXPECT_EQ(repair->late, 4u);  // one of the first pair, three of the second
  EXPECT_EQ(repair->other_clock, 0u);
}

TEST(Stamps, TheFirstOfARepeatStays) {
  const std::vector<TimeNs> t_ns = {0, 10, 20, 20, 30, 20, 40};
  const auto repair = repairStamps(t_ns);
  ASSERT_TRUE(repair.ok());
  EXPECT_THAT(repair->rows, ElementsAre(0, 1, 2, 4, 6));
  EXPECT_EQ(repair->repeats_dropped, 2u);
}

TEST(Stamps, OfTwoInterleavedClocksTheLongerIsKept) {
  // Every other row comes from a device whose clock is 400 ms ahead, from 1 s on.
  std::vector<TimeNs> t_ns;
  std::vector<std::size_t> first_device;
  for (const TimeNs t : every(5, 0, 4000)) {
    first_device.push_back(t_ns.size());
    t_ns.push_back(t);
    if (t >= 1000 * kNsPerMs) t_ns.push_back(t + 400 * kNsPerMs + 1);
  }
  const auto repair = repairStamps(t_ns);
  ASSERT_TRUE(repair.ok());
  EXPECT_EQ(repair->rows, first_device);
  EXPECT_EQ(repair->pieces, 2u);
  EXPECT_EQ(repair->other_clock, 600u);
}

TEST(Stamps, AClockThatIsSetBackLosesOnlyTheOverlap) {
  std::vector<TimeNs> t_ns = every(5, 0, 10000);
  const std::vector<TimeNs> rest = every(5, 9900, 30000);
  t_ns.insert(t_ns.end(), rest.begin(), rest.end());
  const auto repair = repairStamps(t_ns);
  ASSERT_TRUE(repair.ok());
  EXPECT_EQ(pick(t_ns, repair->rows), every(5, 0, 30000));
  EXPECT_EQ(repair->other_clock + repair->repeats_dropped, 20u);
}

TEST(Stamps, AGapIsNoOtherClockAndASingleWildStampIsDropped) {
  std::vector<TimeNs> t_ns = every(5, 0, 1000);
  t_ns.push_back(99'000'000 * kNsPerMs);
  const std::vector<TimeNs> rest = every(5, 5000, 6000);
  t_ns.insert(t_ns.end(), rest.begin(), rest.end());
  const auto repair = repairStamps(t_ns);
  ASSERT_TRUE(repair.ok());
  EXPECT_EQ(repair->rows.size(), 400u);
  EXPECT_EQ(repair->other_clock, 1u);
}

TEST(Stamps, RandomStampsAreRefused) {
  Random random(1);
  std::vector<TimeNs> t_ns(5000);
  TimeNs far = 0;
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    // Most rows a nanosecond apart, so that the median period is tiny, the others far away.
    far += 1'000'000;
    t_ns[i] = i % 3 == 0 ? far : static_cast<TimeNs>(i);
  }
  random.shuffle(t_ns);
  const auto repair = repairStamps(t_ns);
  ASSERT_FALSE(repair.ok());
  EXPECT_THAT(repair.error().message, HasSubstr("no order to recover"));
}

TEST(Stamps, TheBrokenLogKeepsTheDeviceThatFeelsGravity) {
  PARKADE_NEED_DATA(data);
  const auto table = readImuTable(data + "/imu_broken_log/data.csv");
  ASSERT_TRUE(table.ok()) << table.error().message;
  const std::vector<TimeNs> t_ns = table->stamps();
  const StampReport report = checkStamps(t_ns);
  EXPECT_EQ(report.rows, 36576u);
  EXPECT_EQ(report.backward, 10488u);
  EXPECT_EQ(report.repeated, 0u);

  const auto refused = orderRows(table->path, t_ns, table->lines, false);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message,
              AllOf(HasSubstr("data.csv:790:"), HasSubstr("10488 stamps go backwards")));

  test::LogCapture log;
  const auto rows = orderRows(table->path, t_ns, table->lines, true);
  ASSERT_TRUE(rows.ok()) << rows.error().message;
  ASSERT_EQ(log.lines.size(), 1u);
  EXPECT_TRUE(checkStamps(pick(t_ns, *rows)).clean());
  // Two devices write into this log, their clocks 356 ms apart; one sends gravity, one does not.
  double smallest = 100.0;
  for (const std::size_t row : *rows) {
    smallest = std::min(smallest, table->rows[row].accel.norm());
  }
  EXPECT_GT(smallest, 9.0);
  EXPECT_GT(rows->size(), 11000u);
  EXPECT_GT(t_ns[rows->back()] - t_ns[rows->front()], 62 * kNsPerSecond);
}

}  // namespace
}  // namespace parkade
