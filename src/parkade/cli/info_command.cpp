// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "parkade/cli/command.hpp"
#include "parkade/core/progress.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/rig_report.hpp"
#include "parkade/io/sequence_report.hpp"

namespace parkade::cli {
namespace {

struct InfoArguments {
  std::string path;
  std::string json;
  bool images = false;
};

bool isRigFile(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

Status writeJson(const std::string& path, const nlohmann::json& json) {
  return path.empty() ? Status() : writeFileAtomic(path, json.dump(2) + "\n");
}

Result<int> describeRig(const InfoArguments& arguments) {
  const Result<Rig> rig = readRig(arguments.path);
  if (!rig) return rig.error();
  fmt::print("{}", rigText(*rig));
  if (const Status status = writeJson(arguments.json, rigJson(*rig)); !status) {
    return status.error();
  }
  return 0;
}

Result<int> describeFolder(const InfoArguments& arguments) {
  SequenceReportOptions options;
  options.decode_images = arguments.images;
  std::optional<ProgressPrinter> progress;
  if (arguments.images) {
    options.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    progress.emplace("decoding images");
    options.progress = progress->callback();
  }
  const Result<SequenceReport> report = describeSequence(arguments.path, options);
  progress.reset();
  if (!report) return report.error();
  fmt::print("{}", sequenceText(*report));
  if (const Status status = writeJson(arguments.json, sequenceJson(*report)); !status) {
    return status.error();
  }
  return report->failed() ? 1 : 0;
}

}  // namespace

void addInfoCommand(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("info", "Describe a sequence or a rig, and check it");
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option("PATH", arguments->path, "Sequence folder, or rig file (.yaml)")->required();
  command->add_flag("--images", arguments->images,
                    "Decode every image (otherwise the first of each camera)");
  command->add_option("--json", arguments->json, "Write the same as JSON to this file");
  command->footer(
      "Example:\n"
      "  parkade info recordings/garage --images --json garage.json\n"
      "  parkade info config/rigs/avp6.yaml\n"
      "Exit code 1 where a check failed: a run would refuse the sequence as it is.");
  command->callback([arguments, &exit_code] {
    const Result<int> code =
        isRigFile(arguments->path) ? describeRig(*arguments) : describeFolder(*arguments);
    exit_code = code ? *code : fail(code.error());
  });
}

}  // namespace parkade::cli
