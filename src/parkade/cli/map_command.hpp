// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"

namespace parkade::cli {

/// Prints what a map file holds, and writes the same as JSON where that file is named.
Status describeMap(const std::string& path, const std::string& json);

}  // namespace parkade::cli
