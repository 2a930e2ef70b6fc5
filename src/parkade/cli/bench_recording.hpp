// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/cli/bench_plan.hpp"

namespace parkade::cli {

/// Names of the drives whose pictures are those of recordings that the user gave (--sequences): the
/// options of drawing say nothing of them.
std::vector<std::string> givenDrives(const PaperBenchOptions& options, const BenchPlan& plan);

/// Makes sure that the recording of a drive is there, whole: uses it, goes on with it, or draws it.
/// A drive that only tells its reader another rig (BenchDrive::pictures_of) takes the pictures of
/// that one by links. Gives its folder.
Result<std::string> provideSequence(const PaperBenchOptions& options, const BenchDrive& drive);

}  // namespace parkade::cli
