// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "parkade/core/result.hpp"

namespace parkade::cli {

// One function per subcommand, each in its own source. It adds the subcommand with its options and
// an example, and a callback that does the work and stores the exit code: 0 done, 1 failed, 2
// where the command line is wrong.

void addInfoCommand(CLI::App& app, int& exit_code);
void addEvalCommand(CLI::App& app, int& exit_code);
void addBevCommand(CLI::App& app, int& exit_code);
void addMapCommand(CLI::App& app, int& exit_code);
void addRunCommand(CLI::App& app, int& exit_code);
void addSimCommand(CLI::App& app, int& exit_code);
void addBenchCommand(CLI::App& app, int& exit_code);
void addBenchSemantics(CLI::App& bench, int& exit_code);

/// Prints "parkade: MESSAGE" on stderr; returns the exit code 1.
int fail(const Error& error);

/// The same where the command line itself is wrong: 2.
int failUsage(const Error& error);

}  // namespace parkade::cli
