// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace parkade::cli {

/// What 'parkade run --method' takes.
inline const std::vector<std::string> kRunMethods = {"fused", "semantic", "vis", "avp-slam"};

}  // namespace parkade::cli
