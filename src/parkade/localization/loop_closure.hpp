// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/localization/place_decision.hpp"

namespace parkade {

/// Looks for a frame in a submap around an expected pose that is uncertain by sigma_m and
/// sigma_rad: every place within three sigma. Rows of slots fit themselves one slot further; such a
/// loop is refused as ambiguous unless something that does not repeat (an arrow, a marker's text, a
/// row's end) decides. docs/math/registration.md.
LoopResult searchInSubmap(const SemanticFrame& frame, const Submap& submap, const SE2& expected,
                          double sigma_m, double sigma_rad, const LoopOptions& loop,
                          const RegistrationOptions& registration,
                          const std::vector<Eigen::Vector3d>& viewpoints = {});

}  // namespace parkade
