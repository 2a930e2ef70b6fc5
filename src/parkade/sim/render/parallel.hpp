// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace parkade::sim {

/// Calls body(0) ... body(count - 1) on up to that many threads; one thread means the caller's own.
void parallelFor(int threads, std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace parkade::sim
