// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"

namespace parkade::cli {

/// First line of a run's config.yaml, by which its folder is known.
inline constexpr const char* kRunConfigHeading = "# Effective configuration of 'parkade run'";

/// Whether a command may write into a folder. One with something in it is refused, unless forced.
/// Changes nothing.
Status checkOutputFolder(const std::string& folder, bool force);

/// Refuses a recording's folder, or one within it, whatever is forced: a run would replace its
/// rig.yaml.
Status checkIsNoRecording(const std::string& folder);

/// The same as checkOutputFolder() for a run's folder. One that is left of a run that was stopped,
/// without results, will do; one with results needs force, as they will be replaced.
Status checkRunFolder(const std::string& folder, bool force);

/// Whether files of a run's results lie in a folder.
bool holdsResults(const std::string& folder);

/// Refuses the folder of the map that the run reads: the run would replace it.
Status checkMapIsElsewhere(const std::string& folder, const std::string& map);

/// Makes a folder and tries whether files can be written into it.
Status makeWritable(const std::string& folder);

/// Makes a run's folder and, where no results are, writes config.yaml, so that the folder of a run
/// that is stopped is known as a run's. The results of an earlier run stay as they are.
Status beginRunFolder(const std::string& folder, const std::string& config);

/// Writes config.yaml and removes the files of an earlier run, so that none is taken for one of
/// this run. To call when the results are there to be written.
Status clearRunFolder(const std::string& folder, const std::string& config);

}  // namespace parkade::cli
