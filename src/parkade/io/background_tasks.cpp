// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/background_tasks.hpp"

#include <exception>
#include <utility>

namespace parkade {
namespace {

// A task may throw (bad_alloc); a thread must not.
Status runSafely(const BackgroundTasks::Task& task) {
  try {
    return task();
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
}

}  // namespace

BackgroundTasks::BackgroundTasks(int threads, std::size_t queue) : queue_(queue) {
  PARKADE_CHECK(threads >= 0 && queue >= 1, "{} threads, queue of {}", threads, queue);
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
}

BackgroundTasks::~BackgroundTasks() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  work_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

Status BackgroundTasks::problem() const {
  return first_error_ ? Status(*first_error_) : Status();
}

Status BackgroundTasks::submit(Task task) {
  if (threads_.empty()) {
    if (!first_error_) {
      if (const Status status = runSafely(task); !status) first_error_ = status.error();
    }
    return problem();
  }
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return tasks_.size() < queue_; });
  if (!first_error_) tasks_.push_back(std::move(task));
  work_.notify_one();
  return problem();
}

Status BackgroundTasks::wait() {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return tasks_.empty() && running_ == 0; });
  return problem();
}

void BackgroundTasks::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    work_.wait(lock, [this] { return stop_ || !tasks_.empty(); });
    if (tasks_.empty()) return;
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    ++running_;
    const bool skip = first_error_.has_value();
    lock.unlock();
    done_.notify_all();
    Status status = skip ? Status() : runSafely(task);
    lock.lock();
    --running_;
    if (!status && !first_error_) first_error_ = status.error();
    done_.notify_all();
  }
}

}  // namespace parkade
