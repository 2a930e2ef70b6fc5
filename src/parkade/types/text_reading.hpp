// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace parkade {

/// A text with the probability that a reader gives it.
struct TextReading {
  std::string text;
  double probability = 0.0;
};

}  // namespace parkade
