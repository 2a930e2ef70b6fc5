// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace parkade {

/// Into [-45, 45] degrees: what two directions differ by where quarter turns do not count.
inline double wrapQuarter(double angle) {
  return std::remainder(angle, 0.5 * M_PI);
}

}  // namespace parkade
