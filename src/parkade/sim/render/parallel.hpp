// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace parkade::sim {

/// Calls body(0) ... body(count - 1) on up to that many threads; one thread means the caller's own.
void parallelFor(int threads, std::size_t count, const std::function<void(std::size_t)>& body);

/// While it lives, parallelFor keeps to the calling thread: for threads that have whole pictures
/// each, and need not meet at the end of every loop.
class KeepToThread {
 public:
  KeepToThread();
  ~KeepToThread();
  KeepToThread(const KeepToThread&) = delete;
  KeepToThread& operator=(const KeepToThread&) = delete;

 private:
  bool before_;
};

}  // namespace parkade::sim
