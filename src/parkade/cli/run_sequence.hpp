// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/cli/open_source.hpp"
#include "parkade/core/result.hpp"

namespace parkade::cli {

/// What 'parkade run' is told; 'parkade run --help' says what each means.
struct RunArguments {
  SourceRequest source;
  std::string out;
  std::string method = "vis";
  std::string map;
  std::string config;
  std::vector<std::string> assignments;
  std::string debug_images;
  bool with_final = false;
  bool force = false;
  int threads = 2;
  bool real_time = false;
};

/// Opens the source, runs the method over it and writes the run's folder. Throws what CLI11 throws
/// where a setting is wrong. Fails with what is wrong, after a run with what kept it from its end.
Status runSequence(RunArguments arguments);

}  // namespace parkade::cli
