// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "parkade/core/result.hpp"

namespace parkade {

/// All bytes of a file. Fails, with the reason of the system, where it cannot be read.
Result<std::string> readFile(const std::string& path);

/// Writes a file whole or not at all: the bytes go to PATH.tmp, which then takes the name. Whoever
/// finds PATH finds all of it, even where the program was killed. A link stays and what it points
/// to is written; a device or a pipe (/dev/stdout) is written to as it is. Fails with the system's
/// reason.
Status writeFileAtomic(const std::string& path, std::string_view bytes);

/// Makes a folder and those above it. Fails with the system's reason.
Status makeFolders(const std::string& path);

/// Path parts joined by one slash.
std::string joinPath(const std::string& folder, const std::string& name);

}  // namespace parkade
