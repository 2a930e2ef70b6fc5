// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/sequence_files.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <functional>
#include <system_error>

#include "parkade/io/csv.hpp"
#include "parkade/io/file.hpp"

namespace parkade {
namespace {

template <class Row>
Result<SensorTable<Row>> readTable(const std::string& path,
                                   const std::function<Row(const CsvReader&)>& read_row) {
  return parseCsvFile<SensorTable<Row>>(path, CsvReader::Separator::kComma,
                                        [&path, &read_row](CsvReader& csv) {
                                          SensorTable<Row> table;
                                          table.path = path;
                                          while (csv.nextRow()) {
                                            table.rows.push_back(read_row(csv));
                                            table.lines.push_back(csv.line());
                                          }
                                          if (table.rows.empty())
                                            csv.fail("the file holds no row of data");
                                          return table;
                                        });
}

constexpr const char* kStamp = "timestamp [ns]";

}  // namespace

Result<std::string> findSequence(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code code;
  if (!fs::exists(path, code)) return Error{fmt::format("{}: no such file or folder", path)};
  if (fs::is_directory(fs::path(path) / "mav0", code)) return path;
  fs::path clean = fs::path(path) / "";  // "a/mav0" and "a/mav0/" alike
  if (clean.parent_path().filename() != "mav0") {
    clean = fs::absolute(path, code).lexically_normal() / "";  // "." in it
  }
  if (clean.parent_path().filename() == "mav0" && fs::is_directory(clean, code)) {
    const std::string parent = clean.parent_path().parent_path().string();
    return parent.empty() ? std::string(".") : parent;
  }
  return Error{
      fmt::format("{}: not a sequence: expected a folder 'mav0' in it with cam0/, imu0/, ... "
                  "(EuRoC/ASL layout, docs/formats.md)",
                  path)};
}

std::string sensorFolder(const std::string& sequence, const std::string& sensor) {
  return joinPath(joinPath(sequence, "mav0"), sensor);
}

Status checkFinished(const std::string& sequence) {
  const std::string marker = joinPath(sequence, kUnfinishedFile);
  if (!std::filesystem::exists(marker)) return {};
  return Error{fmt::format(
      "{}: the sequence was not written to its end: run the program that wrote it again, which "
      "resumes it, or remove the folder",
      marker)};
}

Result<SensorTable<ImuSample>> readImuTable(const std::string& path) {
  return readTable<ImuSample>(path, [](const CsvReader& csv) {
    csv.expectColumns({kStamp, "gyro x [rad/s]", "gyro y [rad/s]", "gyro z [rad/s]",
                       "accel x [m/s^2]", "accel y [m/s^2]", "accel z [m/s^2]"});
    ImuSample sample;
    sample.t_ns = csv.nanoseconds(0, kStamp);
    sample.gyro = {csv.number(1, "gyro x"), csv.number(2, "gyro y"), csv.number(3, "gyro z")};
    sample.accel = {csv.number(4, "accel x"), csv.number(5, "accel y"), csv.number(6, "accel z")};
    return sample;
  });
}

Result<SensorTable<WheelSample>> readWheelTable(const std::string& path) {
  return readTable<WheelSample>(path, [](const CsvReader& csv) {
    csv.expectColumns({kStamp, "rear_left [m/s]", "rear_right [m/s]", "steering [rad]"});
    WheelSample sample;
    sample.t_ns = csv.nanoseconds(0, kStamp);
    sample.rear_left_mps = csv.numberOrEmpty(1, "rear_left");
    sample.rear_right_mps = csv.numberOrEmpty(2, "rear_right");
    sample.steering_rad = csv.numberOrEmpty(3, "steering");
    return sample;
  });
}

Result<SensorTable<ImageRow>> readImageTable(const std::string& path) {
  return readTable<ImageRow>(path, [](const CsvReader& csv) {
    csv.expectColumns({kStamp, "filename"});
    ImageRow row;
    row.t_ns = csv.nanoseconds(0, kStamp);
    row.file = std::string(csv.text(1));
    if (row.file.empty()) csv.fail(1, "filename", "expected the name of an image, found ''");
    return row;
  });
}

}  // namespace parkade
