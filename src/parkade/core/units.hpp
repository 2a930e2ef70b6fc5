// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace parkade {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< rad

[[nodiscard]] constexpr double square(double value) {
  return value * value;
}

}  // namespace parkade
