// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "parkade/cli/bench_paper.hpp"
#include "parkade/cli/command.hpp"

namespace parkade::cli {

void addBenchCommand(CLI::App& app, int& exit_code) {
  CLI::App* bench = app.add_subcommand(
      "bench", "The paper's tables on simulated drives; bench semantics: networks and features");
  const auto what = std::make_shared<std::string>("paper");
  bench->add_option("WHAT", *what, "paper (default): the tables of the paper")
      ->check(CLI::IsMember({"paper"}));
  const auto options = addPaperBenchOptions(*bench);
  addBenchSemantics(*bench, exit_code);
  bench->callback([bench, options, what, &exit_code] {
    if (!bench->get_subcommands().empty()) return;
    exit_code = runPaperBench(*options);
  });
}

}  // namespace parkade::cli
