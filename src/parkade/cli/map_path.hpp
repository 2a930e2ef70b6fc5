// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "parkade/io/file.hpp"

namespace parkade::cli {

/// A map's file: the path itself, or the one in the folder of the run that made it.
inline std::string mapFileOf(const std::string& path) {
  std::error_code code;  // a folder that cannot be looked into is told by who opens the path
  return std::filesystem::is_directory(path, code) ? joinPath(path, "map.db") : path;
}

}  // namespace parkade::cli
