// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/command.hpp"

namespace parkade::cli {

void addBenchCommand(CLI::App& app, int& exit_code) {
  CLI::App* bench = app.add_subcommand("bench", "Score the program on simulated garages");
  bench->require_subcommand(1);
  addBenchSemantics(*bench, exit_code);
}

}  // namespace parkade::cli
