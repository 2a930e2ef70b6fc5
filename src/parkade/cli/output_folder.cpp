// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/output_folder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "parkade/cli/map_path.hpp"
#include "parkade/cli/report_pictures.hpp"
#include "parkade/io/file.hpp"
#include "parkade/types/grid_layer.hpp"

namespace parkade::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kConfig = "config.yaml";
constexpr const char* kSubfolders[] = {"map", "pictures"};

// All that a run writes but for its configuration.
std::vector<std::string> resultFiles() {
  std::vector<std::string> files = {"map.db",
                                    "map.db-journal",
                                    "trajectory.tum",
                                    "trajectory_vio.tum",
                                    "trajectory_final.tum",
                                    "covariance.csv",
                                    "health.csv",
                                    "timing.json",
                                    "metrics.json",
                                    "report.html",
                                    "rig.yaml",
                                    "map/map.geojson",
                                    "map/map.osm",
                                    "map/map.png"};
  for (const std::string_view layer : kGridLayerNames) {
    for (const char* ending : {".pgm", ".yaml"}) {
      files.push_back("map/" + std::string(layer) + ending);
    }
  }
  files.insert(files.end(), std::begin(kReportPictures), std::end(kReportPictures));
  return files;
}

bool isThere(const fs::path& path) {
  std::error_code code;
  return fs::exists(fs::symlink_status(path, code));
}

bool isRunFolder(const fs::path& folder) {
  const Result<std::string> config = readFile((folder / kConfig).string());
  return config.ok() && config->starts_with(kRunConfigHeading);
}

Status checkIsNoFile(const std::string& folder) {
  std::error_code code;
  if (!fs::exists(folder, code) || fs::is_directory(folder, code)) return {};
  return Error{fmt::format("{}: is a file; --out takes a folder", folder)};
}

bool isEmpty(const std::string& folder) {
  std::error_code code;
  return !fs::exists(folder, code) || fs::is_empty(folder, code);
}

}  // namespace

bool holdsResults(const std::string& folder) {
  const std::vector<std::string> files = resultFiles();
  return std::any_of(files.begin(), files.end(),
                     [&](const std::string& name) { return isThere(fs::path(folder) / name); });
}

Status checkOutputFolder(const std::string& folder, bool force) {
  if (Status status = checkIsNoFile(folder); !status) return status;
  if (force || isEmpty(folder)) return {};
  return Error{fmt::format(
      "{}: the folder is not empty; take another one, or --force to write into it all the same",
      folder)};
}

Status checkIsNoRecording(const std::string& folder) {
  std::error_code code;
  const fs::path path = fs::weakly_canonical(folder, code);
  for (fs::path at = code ? fs::absolute(folder) : path; at.has_relative_path();
       at = at.parent_path()) {
    if (!fs::is_directory(at / "mav0", code)) continue;
    return Error{fmt::format(
        "{}: {} is a recording (it holds mav0/), whose files a run must not replace; take another "
        "--out",
        folder, at.string())};
  }
  return {};
}

Status checkRunFolder(const std::string& folder, bool force) {
  if (Status status = checkIsNoFile(folder); !status) return status;
  if (force || isEmpty(folder)) return {};
  if (!isRunFolder(folder)) {
    return Error{fmt::format(
        "{}: the folder is not empty and not that of a run; take another one, or --force to write "
        "into it all the same",
        folder)};
  }
  if (!holdsResults(folder)) return {};
  return Error{fmt::format(
      "{}: holds the results of a run already; take another folder, or --force to replace them",
      folder)};
}

Status checkMapIsElsewhere(const std::string& folder, const std::string& map) {
  std::error_code code;
  const fs::path file = fs::absolute(mapFileOf(map), code);
  const bool same = fs::equivalent(file.parent_path(), folder, code) ||
                    fs::equivalent(file, fs::path(folder) / "map.db", code);
  if (!same) return {};
  return Error{fmt::format(
      "{}: --map {} lies in this folder, and the run would replace it; take another --out", folder,
      map)};
}

Status makeWritable(const std::string& folder) {
  if (Status made = makeFolders(folder); !made) return made;
  const std::string probe = joinPath(folder, ".parkade_probe");
  const Status written = writeFileAtomic(probe, "");
  if (!written) {
    return Error{
        fmt::format("{}: cannot write into the folder ({})", folder, written.error().message)};
  }
  std::error_code code;
  fs::remove(probe, code);
  return {};
}

Status beginRunFolder(const std::string& folder, const std::string& config) {
  if (Status made = makeWritable(folder); !made) return made;
  const bool keep =
      holdsResults(folder) || (isThere(fs::path(folder) / kConfig) && !isRunFolder(folder));
  return keep ? Status() : writeFileAtomic(joinPath(folder, kConfig), config);
}

Status clearRunFolder(const std::string& folder, const std::string& config) {
  // First, so that the folder is known as a run's from here on.
  if (Status status = writeFileAtomic(joinPath(folder, kConfig), config); !status) return status;
  for (const std::string& name : resultFiles()) {
    std::error_code code;
    fs::remove(fs::path(folder) / name, code);
    if (code) {
      return Error{fmt::format("{}: cannot remove the file of an earlier run: {}",
                               joinPath(folder, name), code.message())};
    }
  }
  for (const char* name : kSubfolders) {
    std::error_code code;  // something of the user's may be in it
    fs::remove(fs::path(folder) / name, code);
  }
  return {};
}

}  // namespace parkade::cli
