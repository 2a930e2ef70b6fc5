// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

// The files of a sequence folder (docs/formats.md, "Sequence folder"), each read as it stands: the
// rows keep the order of the file, whatever their stamps.

/// Rows of a file with the line that each came from.
template <class Row>
struct SensorTable {
  std::string path;
  std::vector<Row> rows;
  std::vector<int> lines;
  [[nodiscard]] std::vector<TimeNs> stamps() const {
    std::vector<TimeNs> t_ns;
    t_ns.reserve(rows.size());
    for (const Row& row : rows) t_ns.push_back(row.t_ns);
    return t_ns;
  }
};

/// An image of a camera's data.csv.
struct ImageRow {
  TimeNs t_ns = 0;   ///< as recorded
  std::string file;  ///< name below the camera's data folder
};

/// The folder that holds mav0, given that folder or mav0 itself. Fails, and says what is expected,
/// where the path is no such folder.
Result<std::string> findSequence(const std::string& path);

/// SEQ/mav0/SENSOR
std::string sensorFolder(const std::string& sequence, const std::string& sensor);

/// A file in a sequence folder while it is being written.
inline constexpr const char* kUnfinishedFile = "UNFINISHED";
/// Fails, and says what to do, where a writer has not finished the sequence.
Status checkFinished(const std::string& sequence);

/// mav0/imu0/data.csv: t_ns, gyro xyz (rad/s), accel xyz (m/s^2).
Result<SensorTable<ImuSample>> readImuTable(const std::string& path);
/// mav0/wheel0/data.csv: t_ns, rear left and right (m/s), steering (rad); empty where unknown.
Result<SensorTable<WheelSample>> readWheelTable(const std::string& path);
/// mav0/camK/data.csv: t_ns, file name.
Result<SensorTable<ImageRow>> readImageTable(const std::string& path);

}  // namespace parkade
