// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>
#include <vector>

#include "parkade/pipeline/pace.hpp"
#include "parkade/pipeline/settling.hpp"
#include "parkade/pipeline/stage_clock.hpp"
#include "parkade/pipeline/thread_pool.hpp"

namespace parkade {
namespace {

TEST(ThreadPool, SharesOutEveryNumberOnce) {
  for (const int threads : {0, 1, 3}) {
    ThreadPool pool(threads);
    std::vector<int> done(100, 0);
    pool.parallelFor(100, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
    EXPECT_EQ(done, std::vector<int>(100, 1)) << threads << " threads";
  }
}

TEST(ThreadPool, LoopGoesOnBesideWorkThatTakesItsTime) {
  ThreadPool pool(1);
  std::atomic<bool> release{false};
  std::future<void> slow = pool.submit([&] {
    while (!release) std::this_thread::yield();
  });
  int sum = 0;  // the only thread is busy: the caller does it all
  pool.parallelFor(10, [&](int i) { sum += i; });
  EXPECT_EQ(sum, 45);
  release = true;
  slow.get();
}

TEST(ThreadPool, HandsExceptionsToTheCaller) {
  ThreadPool pool(2);
  EXPECT_THROW(pool.parallelFor(8,
                                [](int i) {
                                  if (i == 5) throw std::runtime_error("five");
                                }),
               std::runtime_error);
  EXPECT_THROW(pool.submit([] { throw std::runtime_error("no"); }).get(), std::runtime_error);
}

TEST(StageClock, GivesMeanPercentilesAndMaximum) {
  StageClock clock("stage");
  for (int i = 1; i <= 1000; ++i) clock.add(i);
  const StageTiming timing = clock.timing();
  EXPECT_DOUBLE_EQ(timing.mean_ms, 500.5);
  EXPECT_NEAR(timing.p50_ms, 500.0, 10.0);
  EXPECT_NEAR(timing.p95_ms, 950.0, 20.0);
  EXPECT_DOUBLE_EQ(timing.max_ms, 1000.0);
  EXPECT_EQ(timing.count, 1000);
  EXPECT_EQ(StageClock("none").timing().count, 0);
}

TEST(BusyTime, CountsWhatOverlapsOnce) {
  BusyTime busy;
  const BusyTime::Clock::time_point start = BusyTime::Clock::now();
  const auto at = [&](int ms) { return start + std::chrono::milliseconds(ms); };
  busy.add(at(0), at(100));
  busy.add(at(50), at(80));
  busy.add(at(90), at(150));
  busy.add(at(200), at(210));
  EXPECT_NEAR(busy.seconds(), 0.160, 1e-9);
  // Of a stage that ends long after it began, what others have not counted.
  BusyTime slow;
  slow.add(at(140), at(205));
  busy.add(slow);
  EXPECT_NEAR(busy.seconds(), 0.210, 1e-9);
}

TEST(Pace, NothingIsHandedOutBeforeItIsDue) {
  Pace pace(4.0);
  const TimeNs first = fromSeconds(1000.0);
  const Pace::Clock::time_point start = pace.awaitDue(first);
  for (const int ms : {100, 200, 40}) {  // the last one lags behind: due already
    const Pace::Clock::time_point due = pace.awaitDue(first + ms * kNsPerMs);
    EXPECT_EQ(due - start, std::chrono::milliseconds(ms / 4));
    EXPECT_GE(Pace::Clock::now(), due);
  }
}

TEST(Pace, WithoutAPaceAllIsDueNow) {
  Pace pace(0.0);
  const Pace::Clock::time_point before = Pace::Clock::now();
  EXPECT_GE(pace.awaitDue(0), before);
  const Pace::Clock::time_point due = pace.awaitDue(fromSeconds(3600.0));
  EXPECT_LE(due, Pace::Clock::now());
}

TEST(Settling, TakesTimeAfterLongDarknessAlone) {
  Settling settling;
  const auto at = [&](double t, bool tracked) { return settling.settled(fromSeconds(t), tracked); };
  EXPECT_TRUE(at(0.0, true));
  EXPECT_TRUE(at(1.0, false));
  EXPECT_TRUE(at(1.9, true));   // a short one
  EXPECT_TRUE(at(3.0, false));  // dark: nothing is seen that could stand apart
  EXPECT_FALSE(at(4.0, true));
  EXPECT_FALSE(at(5.4, true));
  EXPECT_TRUE(at(5.5, true));
  EXPECT_FALSE(at(9.0, true));  // no frame set in between
}

}  // namespace
}  // namespace parkade
