// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/output_folder.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "parkade/io/file.hpp"

namespace parkade::cli {

namespace fs = std::filesystem;

Status checkIsNoFile(const std::string& folder) {
  std::error_code code;
  if (!fs::exists(folder, code) || fs::is_directory(folder, code)) return {};
  return Error{fmt::format("{}: is a file; --out takes a folder", folder)};
}

bool isEmptyFolder(const std::string& folder) {
  std::error_code code;
  return !fs::exists(folder, code) || fs::is_empty(folder, code);
}

Status checkOutputFolder(const std::string& folder, bool force) {
  if (Status status = checkIsNoFile(folder); !status) return status;
  if (force || isEmptyFolder(folder)) return {};
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

}  // namespace parkade::cli
