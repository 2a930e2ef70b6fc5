// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/run_folder.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <utility>
#include <vector>

#include "parkade/cli/map_path.hpp"
#include "parkade/cli/output_folder.hpp"
#include "parkade/cli/report_pictures.hpp"
#include "parkade/io/file.hpp"
#include "parkade/types/grid_layer.hpp"

namespace parkade::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kConfig = "config.yaml";
constexpr const char* kUnfinished = "unfinished";
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

// Files and, where nothing else is in them, folders of a run's results.
Status removeResults(const std::string& folder) {
  std::error_code code;
  for (const std::string& name : resultFiles()) {
    fs::remove(fs::path(folder) / name, code);
    if (code) {
      return Error{fmt::format("{}: cannot remove the file of an earlier run: {}",
                               joinPath(folder, name), code.message())};
    }
  }
  for (const char* name : kSubfolders) fs::remove(fs::path(folder) / name, code);
  return {};
}

// A run's files, from one folder to another on the same file system.
Status moveResults(const std::string& from, const std::string& to) {
  std::vector<std::string> names = resultFiles();
  names.push_back(kConfig);
  for (const std::string& name : names) {
    const fs::path source = fs::path(from) / name;
    if (!isThere(source)) continue;
    const fs::path target = fs::path(to) / name;
    std::error_code code;
    fs::create_directories(target.parent_path(), code);
    if (!code) fs::rename(source, target, code);
    if (code) {
      return Error{fmt::format("{}: cannot be moved to {}: {}", source.string(), target.string(),
                               code.message())};
    }
  }
  return {};
}

}  // namespace

bool holdsResults(const std::string& folder) {
  const std::vector<std::string> files = resultFiles();
  return std::any_of(files.begin(), files.end(),
                     [&](const std::string& name) { return isThere(fs::path(folder) / name); });
}

Status checkRunFolder(const std::string& folder, bool force) {
  if (Status status = checkIsNoFile(folder); !status) return status;
  if (force || isEmptyFolder(folder)) return {};
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

RunFolder::RunFolder(std::string folder, std::string config, int lock)
    : folder_(std::move(folder)), path_(folder_), config_(std::move(config)), lock_(lock) {}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      path_(std::move(other.path_)),
      config_(std::move(other.config_)),
      lock_(std::exchange(other.lock_, -1)) {}

RunFolder::~RunFolder() {
  if (lock_ >= 0) close(lock_);
}

Result<RunFolder> RunFolder::begin(const std::string& folder, const std::string& config) {
  if (Status made = makeWritable(folder); !made) return made.error();
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  RunFolder taken(folder, config, descriptor);
  if (descriptor >= 0 && flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return Error{
        fmt::format("{}: another run writes into this folder; take another --out", folder)};
  }
  const bool keep =
      holdsResults(folder) || (isThere(fs::path(folder) / kConfig) && !isRunFolder(folder));
  if (!keep) {
    if (Status told = writeFileAtomic(joinPath(folder, kConfig), config); !told) {
      return told.error();
    }
  }
  return taken;
}

Status RunFolder::open() {
  path_ = holdsResults(folder_) ? joinPath(folder_, kUnfinished) : folder_;
  if (Status made = makeFolders(path_); !made) return made;
  // First, so that the folder is known as a run's from here on.
  if (Status status = writeFileAtomic(joinPath(path_, kConfig), config_); !status) return status;
  return removeResults(path_);
}

Error RunFolder::failed(const Error& error) const {
  if (path_ == folder_) return error;
  return {
      fmt::format("{}; the results of the earlier run stay in {}, what could be written of "
                  "this one is in {}",
                  error.message, folder_, path_)};
}

Status RunFolder::keep() {
  if (path_ == folder_) return {};
  if (Status removed = removeResults(folder_); !removed) return removed;
  if (Status moved = moveResults(path_, folder_); !moved) return moved;
  if (Status removed = removeResults(path_); !removed) return removed;  // its empty subfolders
  std::error_code code;  // something of the user's may be in it
  fs::remove(path_, code);
  path_ = folder_;
  return {};
}

}  // namespace parkade::cli
