// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/parallel.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace parkade::sim {
namespace {

TEST(ParallelFor, CallsEachIndexOnce) {
  for (const int threads : {1, 2, 3}) {
    for (const std::size_t count : {0, 1, 2, 1000}) {
      std::vector<std::atomic<int>> calls(count);
      parallelFor(threads, count, [&](std::size_t i) { ++calls[i]; });
      for (const auto& call : calls) EXPECT_EQ(call, 1);
    }
  }
}

TEST(ParallelFor, AnInnerLoopStaysOnItsThread) {
  std::atomic<int> calls = 0;
  parallelFor(2, 4, [&](std::size_t) { parallelFor(2, 5, [&](std::size_t) { ++calls; }); });
  EXPECT_EQ(calls, 20);
}

TEST(ParallelFor, KeepsToAThreadThatAsksForIt) {
  const std::thread::id own = std::this_thread::get_id();
  std::atomic<int> elsewhere = 0;
  {
    const KeepToThread keep;
    parallelFor(3, 1000, [&](std::size_t) { elsewhere += std::this_thread::get_id() != own; });
  }
  EXPECT_EQ(elsewhere, 0);
}

TEST(ParallelFor, PassesOnWhatABodyThrowsAndGoesOnWorking) {
  for (const int threads : {1, 2}) {
    const auto bad = [](std::size_t i) {
      if (i == 7) throw std::runtime_error("seven");
    };
    EXPECT_THROW(parallelFor(threads, 100, bad), std::runtime_error);
    std::atomic<int> calls = 0;
    parallelFor(threads, 10, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 10);
  }
}

}  // namespace
}  // namespace parkade::sim
