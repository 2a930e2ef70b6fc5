// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"

namespace parkade::cli {

/// Refuses a path that is a file, where --out takes a folder.
Status checkIsNoFile(const std::string& folder);

/// Whether a folder is empty or not there.
bool isEmptyFolder(const std::string& folder);

/// Whether a command may write into a folder. One with something in it is refused, unless forced.
/// Changes nothing.
Status checkOutputFolder(const std::string& folder, bool force);

/// Refuses a recording's folder, or one within it, whatever is forced: a run would replace its
/// rig.yaml.
Status checkIsNoRecording(const std::string& folder);

/// Makes a folder and tries whether files can be written into it.
Status makeWritable(const std::string& folder);

}  // namespace parkade::cli
