// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "parkade/io/file.hpp"

namespace parkade::cli {

/// A map's file: the path itself, or the one in the folder of the run that made it.
inline std::string mapFileOf(const std::string& path) {
  return std::filesystem::is_directory(path) ? joinPath(path, "map.db") : path;
}

}  // namespace parkade::cli
