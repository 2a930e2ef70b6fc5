// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/types/trajectory.hpp"

namespace parkade {

// Trajectory files (docs/formats.md, "Trajectories").
//   TUM    "t tx ty tz qx qy qz qw", seconds, blanks between
//   KITTI  twelve numbers: the first three rows of the 4x4 matrix; no stamps
//   EuRoC  "t_ns,px,py,pz,qw,qx,qy,qz[,velocity, biases]", commas between
enum class TrajectoryFormat { kTum, kKitti, kEuroc };

/// "tum", "kitti", "euroc"; nothing for another name.
std::optional<TrajectoryFormat> trajectoryFormatFromName(const std::string& name);
const char* nameOf(TrajectoryFormat format);

struct TrajectoryFile {
  TrajectoryFormat format = TrajectoryFormat::kTum;
  Trajectory poses;         ///< stamps increase strictly
  std::size_t repeats = 0;  ///< rows left out because their stamp was that of the row before
  bool has_stamps = true;   ///< false: KITTI without a times file, the stamp is the index in s
};

struct TrajectoryReadOptions {
  std::optional<TrajectoryFormat> format;  ///< absent: told from the first row
  std::string kitti_times_path;            ///< seconds, one a line; empty: index as seconds
};

/// Reads a trajectory. Of rows with one stamp the first is kept, and the log warns. Fails with
/// file, line and value on a wrong number of columns, text or NaN, stamps that go backwards, a
/// quaternion whose norm is more than 1e-3 from 1 (closer ones are normalised), a matrix that is
/// more than 1e-3 from a rotation (closer ones are replaced by the nearest rotation).
Result<TrajectoryFile> readTrajectory(const std::string& path,
                                      const TrajectoryReadOptions& options = {});

/// Writes a trajectory whole or not at all. TUM stamps have nine decimals, exact; other numbers are
/// the shortest that read back to the same bits. KITTI files hold no stamps.
Status writeTrajectory(const std::string& path, const Trajectory& poses, TrajectoryFormat format);

/// The file with the reference of a sequence folder: mav0/state_groundtruth_estimate0, else mocap0,
/// else vicon0. A path that is a file is given back as it is. Fails where there is none.
Result<std::string> findReference(const std::string& path);

/// Reads the reference that a path means (findReference) as poses of the body: where a sensor.yaml
/// lies beside an EuRoC file, its T_BS tells what the poses were measured at (a mocap marker), and
/// T_world_body = T_world_sensor * T_BS^-1.
Result<TrajectoryFile> readReference(const std::string& path,
                                     const TrajectoryReadOptions& options = {});

}  // namespace parkade
