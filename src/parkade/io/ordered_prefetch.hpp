// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "parkade/core/check.hpp"

namespace parkade {

/// Does numbered pieces of work in background threads, a bounded number ahead of the caller, and
/// hands out the results in the order of the numbers: what the caller sees does not depend on the
/// number of threads. An exception of the work is thrown by the take() of its number.
template <class T>
class OrderedPrefetch {
 public:
  using Work = std::function<T(std::size_t number)>;

  /// count: pieces of work; threads: 0 does the work inside take(); ahead: results held at most,
  /// those being worked on counted, >= 1. work: called from any thread.
  OrderedPrefetch(std::size_t count, Work work, int threads, std::size_t ahead)
      : count_(count), work_(std::move(work)), slots_(threads > 0 ? ahead : 0) {
    PARKADE_CHECK(threads >= 0 && ahead >= 1, "{} threads, {} ahead", threads, ahead);
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
  }

  ~OrderedPrefetch() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    space_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  OrderedPrefetch(const OrderedPrefetch&) = delete;
  OrderedPrefetch& operator=(const OrderedPrefetch&) = delete;

  /// The next result, waited for where it is not there yet. Not to be called after the last one.
  T take() {
    PARKADE_CHECK(taken_ < count_, "all {} results were taken", count_);
    if (threads_.empty()) return work_(taken_++);
    Slot slot;
    {
      std::unique_lock lock(mutex_);
      Slot& mine = slots_[taken_ % slots_.size()];
      ready_.wait(lock, [&mine] { return mine.value.has_value() || mine.problem != nullptr; });
      slot = std::exchange(mine, Slot{});
      ++taken_;
    }
    space_.notify_one();
    if (slot.problem != nullptr) std::rethrow_exception(slot.problem);
    return std::move(*slot.value);
  }

  /// How many results were taken; the number of the next one.
  [[nodiscard]] std::size_t taken() const { return taken_; }

 private:
  struct Slot {
    std::optional<T> value;
    std::exception_ptr problem;
  };

  void run() {
    while (true) {
      std::size_t number = 0;
      {
        std::unique_lock lock(mutex_);
        space_.wait(lock, [this] {
          return stop_ || started_ == count_ || started_ < taken_ + slots_.size();
        });
        if (stop_ || started_ == count_) return;
        number = started_++;
      }
      Slot slot;
      try {
        slot.value = work_(number);
      } catch (...) {
        slot.problem = std::current_exception();
      }
      {
        const std::lock_guard lock(mutex_);
        slots_[number % slots_.size()] = std::move(slot);
      }
      ready_.notify_one();
    }
  }

  const std::size_t count_;
  const Work work_;
  std::mutex mutex_;
  std::condition_variable space_;  // a result was taken
  std::condition_variable ready_;  // a result was added
  std::vector<Slot> slots_;        // result n lies at n % size
  std::size_t started_ = 0;
  std::size_t taken_ = 0;
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace parkade
