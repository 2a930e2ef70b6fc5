// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"

namespace parkade::cli {

/// First line of a run's config.yaml, by which its folder is known.
inline constexpr const char* kRunConfigHeading = "# Effective configuration of 'parkade run'";

/// Whether a run may write into a folder: an empty one, one that is left of a run that was stopped,
/// without results, or any other where forced. Changes nothing.
Status checkRunFolder(const std::string& folder, bool force);

/// Whether files of a run's results lie in a folder.
bool holdsResults(const std::string& folder);

/// Refuses the folder of the map that the run reads: the run would replace it.
Status checkMapIsElsewhere(const std::string& folder, const std::string& map);

/// The folder that one run writes into, from its begin to its end; no other run gets it meanwhile.
/// The results of an earlier run stay until all new ones are written: these go to
/// FOLDER/unfinished first, and take their places when they are complete.
class RunFolder {
 public:
  /// Makes the folder, takes it, and writes config.yaml where no results are, so that the folder of
  /// a run that is stopped is known as a run's. Fails where another run has the folder or it
  /// cannot be written into.
  static Result<RunFolder> begin(const std::string& folder, const std::string& config);

  RunFolder(RunFolder&& other) noexcept;
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  RunFolder& operator=(RunFolder&&) = delete;
  ~RunFolder();

  /// Makes the place ready that results are to be written to, path(), and writes config.yaml there.
  Status open();
  /// The folder itself, or FOLDER/unfinished where an earlier run's results lie.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// What open() says of writing that failed: where the old results and the new ones are.
  [[nodiscard]] Error failed(const Error& error) const;
  /// Replaces an earlier run's results by those in path(). What is not a run's stays.
  Status keep();

 private:
  RunFolder(std::string folder, std::string config, int lock);

  std::string folder_;
  std::string path_;
  std::string config_;
  int lock_;  // descriptor of the folder; negative: the file system has no locks
};

}  // namespace parkade::cli
