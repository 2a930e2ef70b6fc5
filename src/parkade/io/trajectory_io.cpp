// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/trajectory_io.hpp"

#include <fmt/core.h>

#include <Eigen/SVD>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <system_error>
#include <utility>

#include "parkade/camera/calibration_yaml.hpp"
#include "parkade/core/log.hpp"
#include "parkade/core/yaml.hpp"
#include "parkade/io/csv.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/sequence_files.hpp"

namespace parkade {
namespace {

using Separator = CsvReader::Separator;

constexpr double kMaxRotationError = 1e-3;
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr std::size_t kEurocPoseColumns = 8;
constexpr std::size_t kEurocStateColumns = 17;

SO3 readQuaternion(const CsvReader& csv, std::size_t w, std::size_t x, std::size_t y,
                   std::size_t z) {
  const Eigen::Quaterniond q(csv.number(w, "qw"), csv.number(x, "qx"), csv.number(y, "qy"),
                             csv.number(z, "qz"));
  if (std::abs(q.norm() - 1.0) > kMaxRotationError) {
    csv.fail(
        fmt::format("the quaternion (w {}, x {}, y {}, z {}) has norm {}, expected 1: are the "
                    "columns in the order of another format?",
                    q.w(), q.x(), q.y(), q.z(), q.norm()));
  }
  return SO3(q);
}

Eigen::Vector3d readPosition(const CsvReader& csv, std::size_t first) {
  return {csv.number(first, "x"), csv.number(first + 1, "y"), csv.number(first + 2, "z")};
}

StampedPose readTumRow(const CsvReader& csv) {
  csv.expectColumns({"t [s]", "tx", "ty", "tz", "qx", "qy", "qz", "qw"});
  return {csv.seconds(0, "t"), SE3(readQuaternion(csv, 7, 4, 5, 6), readPosition(csv, 1))};
}

StampedPose readEurocRow(const CsvReader& csv) {
  if (csv.count() != kEurocStateColumns && csv.count() != kEurocPoseColumns) {
    csv.fail(fmt::format(
        "expected 8 columns (t_ns, position xyz, quaternion wxyz) or 17 (and velocity, biases of "
        "gyroscope and accelerometer), found {}",
        csv.count()));
  }
  return {csv.nanoseconds(0, "timestamp [ns]"),
          SE3(readQuaternion(csv, 4, 5, 6, 7), readPosition(csv, 1))};
}

// The matrix as printed has 6 to 9 digits; the nearest rotation (in the Frobenius norm) is U V'.
SE3 readKittiRow(const CsvReader& csv) {
  if (csv.count() != kKittiColumns) {
    csv.fail(
        fmt::format("expected 12 columns (three rows of a 4x4 matrix), found {}", csv.count()));
  }
  Eigen::Matrix<double, 3, 4> m;
  for (int i = 0; i < 12; ++i) {
    m(i / 4, i % 4) = csv.number(static_cast<std::size_t>(i), "matrix element");
  }
  const Eigen::Matrix3d R = m.leftCols<3>();
  const double error = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (error > kMaxRotationError || R.determinant() < 0.0) {
    csv.fail(fmt::format("the matrix is no rotation: |R R' - I| = {}, det R = {}", error,
                         R.determinant()));
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  return {SO3(nearest), m.col(3)};
}

// Appends a pose; of equal stamps the first stays, earlier ones are an error.
void append(TrajectoryFile& file, const StampedPose& pose, const CsvReader& csv) {
  if (!file.poses.empty() && pose.t_ns <= file.poses.back().t_ns) {
    if (pose.t_ns < file.poses.back().t_ns) {
      csv.fail(fmt::format("stamp {} s lies before the row above ({} s): sort the file",
                           formatSeconds(pose.t_ns), formatSeconds(file.poses.back().t_ns)));
    }
    ++file.repeats;
    return;
  }
  file.poses.push_back(pose);
}

Result<std::vector<TimeNs>> readTimes(const std::string& path) {
  return parseCsvFile<std::vector<TimeNs>>(path, Separator::kBlank, [](CsvReader& csv) {
    std::vector<TimeNs> times;
    while (csv.nextRow()) {
      csv.expectColumns({"t [s]"});
      times.push_back(csv.seconds(0, "t"));
    }
    return times;
  });
}

TrajectoryFile readRows(CsvReader& csv, TrajectoryFormat format,
                        const std::optional<std::vector<TimeNs>>& times) {
  TrajectoryFile file;
  file.format = format;
  file.has_stamps = format != TrajectoryFormat::kKitti || times.has_value();
  std::size_t index = 0;
  while (csv.nextRow()) {
    switch (format) {
      case TrajectoryFormat::kTum:
        append(file, readTumRow(csv), csv);
        break;
      case TrajectoryFormat::kEuroc:
        append(file, readEurocRow(csv), csv);
        break;
      case TrajectoryFormat::kKitti: {
        if (times && index >= times->size()) {
          csv.fail(fmt::format("pose {} has no time: the times file holds {}", index + 1,
                               times->size()));
        }
        const TimeNs t_ns = times ? (*times)[index] : static_cast<TimeNs>(index) * kNsPerSecond;
        append(file, {t_ns, readKittiRow(csv)}, csv);
        break;
      }
    }
    ++index;
  }
  if (index == 0) csv.fail("the file holds no pose");
  if (times && index != times->size()) {
    csv.fail(fmt::format("{} poses, but the times file holds {}", index, times->size()));
  }
  return file;
}

// The format that the first row shows.
Result<TrajectoryFormat> detect(const std::string& path) {
  return parseCsvFile<TrajectoryFormat>(path, Separator::kBlank, [](CsvReader& csv) {
    if (!csv.nextRow()) csv.fail("the file holds no pose");
    for (std::size_t i = 0; i < csv.count(); ++i) {
      if (csv.text(i).find(',') != std::string_view::npos) return TrajectoryFormat::kEuroc;
    }
    if (csv.count() == kTumColumns) return TrajectoryFormat::kTum;
    if (csv.count() == kKittiColumns) return TrajectoryFormat::kKitti;
    csv.fail(fmt::format(
        "cannot tell the format: expected 8 columns (TUM) or 12 (KITTI) with blanks between, or 8 "
        "or 17 (EuRoC) with commas, found {} beginning with '{}'",
        csv.count(), csv.text(0)));
  });
}

void appendTum(std::string& text, const StampedPose& pose) {
  const Eigen::Vector3d& p = pose.T_world_body.translation();
  const Eigen::Quaterniond& q = pose.T_world_body.rotation().quaternion();
  fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {}\n", formatSeconds(pose.t_ns),
                 p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

void appendEuroc(std::string& text, const StampedPose& pose) {
  const Eigen::Vector3d& p = pose.T_world_body.translation();
  const Eigen::Quaterniond& q = pose.T_world_body.rotation().quaternion();
  fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{}\n", pose.t_ns, p.x(), p.y(),
                 p.z(), q.w(), q.x(), q.y(), q.z());
}

void appendKitti(std::string& text, const StampedPose& pose) {
  const Eigen::Matrix4d m = pose.T_world_body.matrix();
  for (int i = 0; i < 12; ++i) {
    fmt::format_to(std::back_inserter(text), "{}{}", m(i / 4, i % 4), i == 11 ? "\n" : " ");
  }
}

}  // namespace

std::optional<TrajectoryFormat> trajectoryFormatFromName(const std::string& name) {
  if (name == "tum") return TrajectoryFormat::kTum;
  if (name == "kitti") return TrajectoryFormat::kKitti;
  if (name == "euroc") return TrajectoryFormat::kEuroc;
  return std::nullopt;
}

const char* nameOf(TrajectoryFormat format) {
  switch (format) {
    case TrajectoryFormat::kTum:
      return "tum";
    case TrajectoryFormat::kKitti:
      return "kitti";
    case TrajectoryFormat::kEuroc:
      return "euroc";
  }
  return "?";
}

Result<TrajectoryFile> readTrajectory(const std::string& path,
                                      const TrajectoryReadOptions& options) {
  Result<TrajectoryFormat> format =
      options.format ? Result<TrajectoryFormat>(*options.format) : detect(path);
  if (!format) return format.error();
  std::optional<std::vector<TimeNs>> times;
  if (!options.kitti_times_path.empty()) {
    if (*format != TrajectoryFormat::kKitti) {
      return Error{fmt::format("{}: a times file goes with KITTI trajectories, this is {}", path,
                               nameOf(*format))};
    }
    Result<std::vector<TimeNs>> read = readTimes(options.kitti_times_path);
    if (!read) return read.error();
    times = std::move(*read);
  }
  const Separator separator =
      *format == TrajectoryFormat::kEuroc ? Separator::kComma : Separator::kBlank;
  Result<TrajectoryFile> file = parseCsvFile<TrajectoryFile>(
      path, separator, [&format, &times](CsvReader& csv) { return readRows(csv, *format, times); });
  if (file && file->repeats > 0) {
    logWarning("{}: {} rows repeat the stamp of the row above; the first of each was kept", path,
               file->repeats);
  }
  return file;
}

Status writeTrajectory(const std::string& path, const Trajectory& poses, TrajectoryFormat format) {
  std::string text;
  if (format == TrajectoryFormat::kTum) text = "# t [s] tx ty tz qx qy qz qw\n";
  if (format == TrajectoryFormat::kEuroc) {
    text = "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n";
  }
  for (const StampedPose& pose : poses) {
    switch (format) {
      case TrajectoryFormat::kTum:
        appendTum(text, pose);
        break;
      case TrajectoryFormat::kKitti:
        appendKitti(text, pose);
        break;
      case TrajectoryFormat::kEuroc:
        appendEuroc(text, pose);
        break;
    }
  }
  return writeFileAtomic(path, text);
}

Result<std::string> findReference(const std::string& path) {
  std::error_code code;
  if (std::filesystem::is_regular_file(path, code)) return path;
  const Result<std::string> sequence = findSequence(path);
  if (!sequence) return sequence.error();
  for (const char* sensor : {"state_groundtruth_estimate0", "mocap0", "vicon0"}) {
    const std::string file = joinPath(sensorFolder(*sequence, sensor), "data.csv");
    if (std::filesystem::is_regular_file(file, code)) return file;
  }
  return Error{fmt::format(
      "{}: no reference: expected mav0/state_groundtruth_estimate0/data.csv (or mocap0, vicon0)",
      path)};
}

Result<TrajectoryFile> readReference(const std::string& path,
                                     const TrajectoryReadOptions& options) {
  const Result<std::string> data = findReference(path);
  if (!data) return data.error();
  Result<TrajectoryFile> file = readTrajectory(*data, options);
  const auto sensor = std::filesystem::path(*data).parent_path() / "sensor.yaml";
  std::error_code code;
  if (!file || file->format != TrajectoryFormat::kEuroc ||
      !std::filesystem::is_regular_file(sensor, code)) {
    return file;
  }
  const auto T_body_sensor = parseYamlFile<SE3>(sensor.string(), [](const YamlNode& root) {
    return root.has("T_BS") ? readTransform(root.at("T_BS")) : SE3();
  });
  if (!T_body_sensor) return T_body_sensor.error();
  const SE3 T_sensor_body = T_body_sensor->inverse();
  for (StampedPose& pose : file->poses) pose.T_world_body = pose.T_world_body * T_sensor_body;
  return file;
}

}  // namespace parkade
