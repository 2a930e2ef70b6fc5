// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/cli/bench_plan.hpp"

namespace parkade::cli {

/// The bytes of a file; none where it cannot be read.
std::string textOrEmpty(const std::string& path);

/// What a run works with besides its variant.
struct RunInputs {
  std::string cameras;  ///< of --cameras
  int threads = 1;
  std::string sequence;    ///< folder of the recording
  std::string trajectory;  ///< file, where it is imported
};

/// Stands for all that decides the figures of a run: the program, the method with its options, the
/// recording and its truth, threads (they decide the times), and the files of networks: Parkade's
/// own where the program looks for them, and those that settings name.
std::string runKey(const BenchVariant& variant, const RunInputs& inputs);

}  // namespace parkade::cli
