// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "parkade/core/result.hpp"

namespace parkade {

/// Runs tasks that do not depend on each other in background threads; a bounded number waits.
class BackgroundTasks {
 public:
  using Task = std::function<Status()>;

  /// threads: 0 runs a task inside submit(); queue: tasks that wait at most, >= 1.
  BackgroundTasks(int threads, std::size_t queue);
  /// Runs what waits to its end.
  ~BackgroundTasks();
  BackgroundTasks(const BackgroundTasks&) = delete;
  BackgroundTasks& operator=(const BackgroundTasks&) = delete;

  /// Adds a task and waits while the queue is full. Returns the first Error of any task so far;
  /// after one no task is run.
  Status submit(Task task);
  /// Waits for all tasks; the first Error of any.
  Status wait();

 private:
  void run();
  [[nodiscard]] Status problem() const;  // under the lock

  std::mutex mutex_;
  std::condition_variable work_;  // a task was added, or stop
  std::condition_variable done_;  // a task was taken or ended
  std::deque<Task> tasks_;
  const std::size_t queue_;
  std::size_t running_ = 0;
  bool stop_ = false;
  std::optional<Error> first_error_;
  std::vector<std::thread> threads_;
};

}  // namespace parkade
