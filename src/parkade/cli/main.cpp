// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <malloc.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>
#include <string>

#include "parkade/cli/command.hpp"
#include "parkade/core/log.hpp"

namespace parkade::cli {
namespace {

constexpr int kWrongUsage = 2;

void logToStderr() {
  const auto logger = spdlog::stderr_color_mt("parkade");
  logger->set_pattern("%^%l%$: %v");
  setLogSink([logger](LogLevel level, std::string_view message) {
    switch (level) {
      case LogLevel::kDebug:
        logger->debug(message);
        break;
      case LogLevel::kInfo:
        logger->info(message);
        break;
      case LogLevel::kWarning:
        logger->warn(message);
        break;
      case LogLevel::kError:
        logger->error(message);
        break;
    }
  });
}

// Pictures come and go by the hundred: their memory is kept, not handed back and zeroed anew.
void keepLargeBlocks() {
#ifdef __GLIBC__
  constexpr int kLargest = 16 << 20;  // glibc's limit is 32 MB
  mallopt(M_MMAP_THRESHOLD, kLargest);
  mallopt(M_TRIM_THRESHOLD, 4 * kLargest);
#endif
}

int run(int argc, char** argv) {
  keepLargeBlocks();
  CLI::App app{"Parkade: semantic visual-inertial SLAM for automated valet parking", "parkade"};
  app.set_version_flag("--version", "parkade " PARKADE_VERSION);
  app.set_help_flag("-h,--help", "Show this help and exit");
  app.require_subcommand(1);
  app.footer("'parkade COMMAND --help' explains a command and shows an example.");
  int exit_code = 0;
#ifdef PARKADE_WITH_SIM
  addSimCommand(app, exit_code);
#endif
#ifdef PARKADE_WITH_PIPELINE
  addRunCommand(app, exit_code);
#endif
#ifdef PARKADE_WITH_BEV
  addBevCommand(app, exit_code);
#endif
#ifdef PARKADE_WITH_BENCH
  addBenchCommand(app, exit_code);
#endif
#ifdef PARKADE_WITH_EVAL
  addEvalCommand(app, exit_code);
#endif
#ifdef PARKADE_WITH_MAPPING
  addMapCommand(app, exit_code);
#endif
#ifdef PARKADE_WITH_IO
  addInfoCommand(app, exit_code);
#endif
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::vector<std::string> unknown = app.remaining(true);
    const bool no_command = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                            dynamic_cast<const CLI::CallForHelp*>(&error) != nullptr;
    if (no_command && !unknown.empty() && unknown.front().rfind('-', 0) != 0) {
      return failUsage({fmt::format("there is no command '{}'; 'parkade --help' lists all commands",
                                    unknown.front())});
    }
    return app.exit(error) == 0 ? 0 : kWrongUsage;
  }
  return exit_code;
}

// A full disk behind stdout shows only here.
int flushOutput(int exit_code) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || exit_code != 0) return exit_code;
  return fail({"what the command prints could not be written (is the disk full?)"});
}

}  // namespace

int fail(const Error& error) {
  const std::string line = fmt::format("parkade: {}\n", error.message);
  std::fputs(line.c_str(), stderr);  // closed or full: the exit code is left
  return 1;
}

int failUsage(const Error& error) {
  fail(error);
  return kWrongUsage;
}

}  // namespace parkade::cli

int main(int argc, char** argv) {
  try {
    parkade::cli::logToStderr();
    return parkade::cli::flushOutput(parkade::cli::run(argc, argv));
  } catch (const std::exception& error) {
    return parkade::cli::fail({fmt::format("internal error: {}", error.what())});
  }
}
