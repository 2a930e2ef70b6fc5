// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "parkade/io/background_tasks.hpp"
#include "parkade/io/ordered_prefetch.hpp"

namespace parkade {
namespace {

TEST(OrderedPrefetch, KeepsTheOrderForAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 4}) {
    OrderedPrefetch<std::size_t> prefetch(
        200,
        [](std::size_t i) {
          if (i % 7 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
          return i * i;
        },
        threads, 5);
    for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(prefetch.take(), i * i);
  }
}

TEST(OrderedPrefetch, StaysWithinItsBound) {
  std::atomic<int> begun{0};
  OrderedPrefetch<int> prefetch(
      100, [&begun](std::size_t) { return ++begun; }, 2, 3);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_LE(begun.load(), 3);
  prefetch.take();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_LE(begun.load(), 4);
}  // and ends here, with most of the work not taken

TEST(OrderedPrefetch, HandsOnAnExceptionInItsPlace) {
  OrderedPrefetch<int> prefetch(
      3,
      [](std::size_t i) -> int {
        if (i == 1) throw std::runtime_error("one");
        return static_cast<int>(i);
      },
      2, 2);
  EXPECT_EQ(prefetch.take(), 0);
  EXPECT_THROW(prefetch.take(), std::runtime_error);
  EXPECT_EQ(prefetch.take(), 2);
  EXPECT_THROW(prefetch.take(), CheckError);
}

TEST(BackgroundTasks, RunsAllAndReportsTheFirstError) {
  for (const int threads : {0, 1, 3}) {
    std::atomic<int> done{0};
    BackgroundTasks tasks(threads, 2);
    for (int i = 0; i < 50; ++i) {
      ASSERT_TRUE(tasks
                      .submit([&done] {
                        ++done;
                        return Status();
                      })
                      .ok());
    }
    ASSERT_TRUE(tasks.wait().ok());
    EXPECT_EQ(done.load(), 50);
    static_cast<void>(tasks.submit([]() -> Status { return Error{"disk full"}; }));
    EXPECT_EQ(tasks.wait().error().message, "disk full");
    static_cast<void>(tasks.submit([&done] {
      ++done;
      return Status();
    }));
    EXPECT_FALSE(tasks.wait().ok());
    EXPECT_EQ(done.load(), 50);  // nothing runs after an error
  }
}

TEST(BackgroundTasks, TurnsAnExceptionIntoAnError) {
  BackgroundTasks tasks(1, 1);
  static_cast<void>(tasks.submit([]() -> Status { throw std::runtime_error("no memory"); }));
  EXPECT_EQ(tasks.wait().error().message, "no memory");
}

}  // namespace
}  // namespace parkade
