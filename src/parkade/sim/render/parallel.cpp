// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace parkade::sim {
namespace {

// Threads that stay, each with its buffers. Not TBB's: Embree's device, which must build its trees
// on one thread, holds the whole process to one TBB thread while it lives.
class Workers {
 public:
  ~Workers() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  void run(int helpers, std::size_t count, const std::function<void(std::size_t)>& body) {
    {
      const std::lock_guard lock(mutex_);
      while (static_cast<int>(threads_.size()) < helpers) {
        threads_.emplace_back([this, seen = round_] { work(seen); });
      }
      body_ = &body;
      count_ = count;
      next_ = 0;
      places_ = helpers;
      ++round_;
    }
    changed_.notify_all();
    take(count, body);
    std::unique_lock lock(mutex_);
    places_ = 0;  // who has not begun yet need not
    changed_.wait(lock, [this] { return busy_ == 0; });
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

  std::atomic<bool> taken = false;  ///< one call at a time; a body's own call stays on its thread

 private:
  void take(std::size_t count, const std::function<void(std::size_t)>& body) {
    try {
      for (std::size_t i = next_++; i < count; i = next_++) body(i);
    } catch (...) {
      next_ = count;  // the others stop early
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
  }

  void work(std::uint64_t seen) {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return ending_ || (round_ != seen && places_ > 0); });
      if (ending_) return;
      seen = round_;
      --places_;
      ++busy_;
      const std::size_t count = count_;
      const auto* body = body_;
      lock.unlock();
      take(count, *body);
      lock.lock();
      --busy_;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::thread> threads_;
  const std::function<void(std::size_t)>* body_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_ = 0;
  int places_ = 0;
  int busy_ = 0;
  std::uint64_t round_ = 0;
  std::exception_ptr failure_;
  bool ending_ = false;
};

thread_local bool keeps_to_thread = false;

}  // namespace

KeepToThread::KeepToThread() : before_(std::exchange(keeps_to_thread, true)) {}
KeepToThread::~KeepToThread() {
  keeps_to_thread = before_;
}

void parallelFor(int threads, std::size_t count, const std::function<void(std::size_t)>& body) {
  static Workers workers;
  if (threads <= 1 || count <= 1 || keeps_to_thread || workers.taken.exchange(true)) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  try {
    workers.run(threads - 1, count, body);
  } catch (...) {
    workers.taken = false;
    throw;
  }
  workers.taken = false;
}

}  // namespace parkade::sim
