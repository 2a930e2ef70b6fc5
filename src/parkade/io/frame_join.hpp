// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/core/time.hpp"

namespace parkade {

/// The images of one instant: for each camera the place of its image in its own list, or -1.
struct JoinedFrame {
  TimeNs t_ns = 0;          ///< mean stamp of the images joined
  std::vector<int> images;  ///< per camera
};

/// Joins the images of several cameras (each with increasing stamps on one clock): the earliest
/// image not yet used opens a frame, and each other camera's next image belongs to it where it lies
/// at most `tolerance` later. The result is ordered by t_ns.
/// Fails where the tolerance is more than half of a camera's median period: two images of one
/// camera could then belong to one instant.
Result<std::vector<JoinedFrame>> joinFrames(const std::vector<std::vector<TimeNs>>& stamps,
                                            TimeNs tolerance);

/// 5 ms, or half the period of the fastest camera where that is less.
TimeNs usualJoinTolerance(const std::vector<std::vector<TimeNs>>& stamps);

/// Median step of increasing stamps; 0 for less than two.
TimeNs medianStep(const std::vector<TimeNs>& t_ns);

}  // namespace parkade
