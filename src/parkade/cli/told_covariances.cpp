// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/told_covariances.hpp"

#include <filesystem>

#include "parkade/io/file.hpp"
#include "parkade/io/pose_covariance_io.hpp"

namespace parkade::cli {

Status judgeCovariances(const std::string& folder, const Trajectory& estimate,
                        const Trajectory& reference, const AssociationOptions& association,
                        Evaluation& evaluation) {
  const std::string path = joinPath(folder, "covariance.csv");
  if (!std::filesystem::is_regular_file(path)) return {};
  const auto covariances = readPoseCovariances(path);
  if (!covariances) return covariances.error();
  const auto consistency = poseConsistency(estimate, *covariances, reference, association);
  if (consistency) evaluation.consistency = *consistency;
  return {};
}

}  // namespace parkade::cli
