// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "parkade/cli/command.hpp"
#ifdef PARKADE_WITH_MAPPING
#include "parkade/cli/map_command.hpp"
#include "parkade/cli/map_path.hpp"
#endif
#include "parkade/core/json_text.hpp"
#include "parkade/core/progress.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/rig_checks.hpp"
#include "parkade/io/rig_report.hpp"
#include "parkade/io/sequence_files.hpp"
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

#ifdef PARKADE_WITH_MAPPING
// A map file, by its ending or by SQLite's first bytes; or a run's folder that holds one.
bool isMap(const std::string& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) {
    return !findSequence(path) && std::filesystem::exists(mapFileOf(path), code);
  }
  if (std::filesystem::path(path).extension() == ".db") return true;
  std::string head(15, '\0');
  return std::ifstream(path, std::ios::binary)
             .read(head.data(), static_cast<std::streamsize>(head.size())) &&
         head == "SQLite format 3";
}

Result<int> describeMapFile(const InfoArguments& arguments) {
  const Status status = describeMap(mapFileOf(arguments.path), arguments.json);
  if (!status) return status.error();
  return 0;
}
#endif

Status writeJson(const std::string& path, const nlohmann::json& json) {
  if (path.empty()) return {};
  return writeFileAtomic(path, jsonText(json));
}

Result<int> describeRig(const InfoArguments& arguments) {
  const Result<Rig> rig = readRig(arguments.path);
  if (!rig) return rig.error();
  const std::vector<Check> checks = checkRig(*rig);
  fmt::print("{}{}", rigText(*rig), checksText(checks));
  if (const Status status = writeJson(arguments.json, rigJson(*rig)); !status) {
    return status.error();
  }
  return anyFailed(checks) ? 1 : 0;
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

Result<int> describePath(const InfoArguments& arguments) {
  if (isRigFile(arguments.path)) return describeRig(arguments);
#ifdef PARKADE_WITH_MAPPING
  if (isMap(arguments.path)) return describeMapFile(arguments);
#endif
  return describeFolder(arguments);
}

}  // namespace

void addInfoCommand(CLI::App& app, int& exit_code) {
  auto* command =
      app.add_subcommand("info", "Describe a sequence or a rig, and check it; describe a map");
  const auto arguments = std::make_shared<InfoArguments>();
  command
      ->add_option("PATH", arguments->path,
                   "Sequence folder, rig file (.yaml), map file (map.db) or folder of a run")
      ->required();
  command->add_flag("--images", arguments->images,
                    "Decode every image (otherwise the first of each camera)");
  command->add_option("--json", arguments->json, "Write the same as JSON to this file");
  command->footer(
      "Examples:\n"
      "  parkade info recordings/garage --images --json garage.json\n"
      "  parkade info config/rigs/avp6.yaml\n"
      "  parkade info OUT/map.db\n"
      "Exit code 1 where a check failed: a run would refuse the sequence as it is.");
  command->callback([arguments, &exit_code] {
    const Result<int> code = describePath(*arguments);
    exit_code = code ? *code : fail(code.error());
  });
}

}  // namespace parkade::cli
