// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

namespace parkade {

/// A few threads that take work in the order given. With no threads, work is done by whoever gives
/// it, at once: results must not depend on which.
class ThreadPool {
 public:
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Ready when the work is done; get() throws what the work threw.
  std::future<void> submit(std::function<void()> work);

  /// body(0) .. body(count - 1), shared between the caller and the threads that are idle; returns
  /// when all are done. Throws the first exception of a body, by number.
  void parallelFor(int count, const std::function<void(int)>& body);

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::packaged_task<void()>> queue_;
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace parkade
