// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/cli/bench_plan.hpp"

namespace parkade::cli {

/// Makes sure that the recording of a drive is there, whole: uses it, goes on with it, or draws it.
/// A drive that only tells its reader another rig (BenchDrive::pictures_of) takes the pictures of
/// that one by links. Gives its folder.
Result<std::string> provideSequence(const PaperBenchOptions& options, const BenchDrive& drive);

}  // namespace parkade::cli
