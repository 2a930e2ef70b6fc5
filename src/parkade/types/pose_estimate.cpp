// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/types/pose_estimate.hpp"

namespace parkade {

const char* toString(Health health) {
  switch (health) {
    case Health::kInitialising:
      return "initialising";
    case Health::kTracking:
      return "tracking";
    case Health::kDegraded:
      return "degraded";
    case Health::kLost:
      return "lost";
  }
  return "unknown";
}

}  // namespace parkade
