// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/thread_pool.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <utility>

namespace parkade {

ThreadPool::ThreadPool(int threads) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

std::future<void> ThreadPool::submit(std::function<void()> work) {
  std::packaged_task<void()> task(std::move(work));
  std::future<void> done = task.get_future();
  if (threads_.empty()) {
    task();
    return done;
  }
  {
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(task));
  }
  wake_.notify_one();
  return done;
}

void ThreadPool::parallelFor(int count, const std::function<void(int)>& body) {
  // Helpers may come late, when all is done and the caller has left: what they look at is shared.
  struct Work {
    explicit Work(int n) : total(n), problems(static_cast<std::size_t>(n)) {}
    const int total;
    std::atomic<int> next{0};
    int done = 0;
    std::mutex mutex;
    std::condition_variable all_done;
    std::vector<std::exception_ptr> problems;
  };
  if (count <= 0) return;
  const auto work = std::make_shared<Work>(count);
  const auto* borrowed = &body;  // alive as long as a number is handed out that is not done
  const auto help = [work, borrowed] {
    for (int i = work->next++; i < work->total; i = work->next++) {
      try {
        (*borrowed)(i);
      } catch (...) {
        work->problems[static_cast<std::size_t>(i)] = std::current_exception();
      }
      const std::lock_guard lock(work->mutex);
      if (++work->done == work->total) work->all_done.notify_all();
    }
  };
  const int helpers = std::min(static_cast<int>(threads_.size()), count - 1);
  for (int i = 0; i < helpers; ++i) (void)submit(help);
  help();
  {
    std::unique_lock lock(work->mutex);
    work->all_done.wait(lock, [&] { return work->done == work->total; });
  }
  for (const std::exception_ptr& problem : work->problems) {
    if (problem != nullptr) std::rethrow_exception(problem);
  }
}

void ThreadPool::run() {
  while (true) {
    std::packaged_task<void()> task;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stop_ || !queue_.empty(); });
      if (queue_.empty()) return;
      task = std::move(queue_.front());
      queue_.pop_front();
    }
    task();
  }
}

}  // namespace parkade
