// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/sequence_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "parkade/camera/rig.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/frame_join.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/io/ordered_prefetch.hpp"
#include "parkade/io/rig_checks.hpp"
#include "parkade/io/sequence_files.hpp"
#include "parkade/io/trajectory_io.hpp"

namespace parkade {
namespace {

namespace fs = std::filesystem;

constexpr double kGravity = 9.81;
constexpr double kGravityTolerance = 0.3;  // bias, scale and latitude of any sane accelerometer
constexpr double kRateTolerance = 0.05;

double distance(const Trajectory& poses) {
  double length = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length +=
        (poses[i].T_world_body.translation() - poses[i - 1].T_world_body.translation()).norm();
  }
  return length;
}

// Collects the report; one function for each part of a sequence.
class Describer {
 public:
  Describer(std::string sequence, const SequenceReportOptions& options)
      : sequence_(std::move(sequence)), options_(options) {}

  SequenceReport describe(const std::string& path) {
    report_.path = path;
    const Status finished = checkFinished(sequence_);
    if (!finished) add(CheckMark::kFail, "finished", finished.error().message);
    Result<Rig> rig = readSequenceRig(sequence_);
    if (rig) {
      rig_ = std::move(*rig);
      add(CheckMark::kPass, "calibration", fmt::format("{} cameras, imu", rig_->cameras.size()));
      const std::vector<Check> checks = checkRig(*rig_);
      report_.checks.insert(report_.checks.end(), checks.begin(), checks.end());
    } else {
      add(CheckMark::kFail, "calibration", rig.error().message);
    }
    describeImu();
    describeCameras();
    describeFrames();
    describeImages();
    describeWheel();
    describeReference();
    describeSpan();
    return std::move(report_);
  }

 private:
  void add(CheckMark mark, const std::string& name, const std::string& detail) {
    report_.checks.push_back({mark, name, detail});
  }
  void addStampCheck(const std::string& name, const std::vector<TimeNs>& t_ns,
                     const std::vector<int>& lines, const StreamStatistics& stream);
  void addRateCheck(const std::string& name, const StreamStatistics& stream, double expected_hz);
  void describeImu();
  void judgeImu(const ImuReport& imu);
  void describeCameras();
  void describeCamera(const RigCamera& camera);
  void describeFrames();
  void describeImages();
  void describeWheel();
  void describeReference();
  void describeSpan();

  std::string sequence_;
  const SequenceReportOptions& options_;
  SequenceReport report_;
  std::optional<Rig> rig_;
  std::vector<ImuSample> imu_samples_;                 // in order
  std::vector<std::vector<TimeNs>> image_t_ns_;        // per camera, in order, on the IMU's clock
  std::vector<std::vector<std::string>> image_paths_;  // of files that are there
};

void Describer::addStampCheck(const std::string& name, const std::vector<TimeNs>& t_ns,
                              const std::vector<int>& lines, const StreamStatistics& stream) {
  if (stream.stamps.clean()) {
    add(CheckMark::kPass, name + " stamps", fmt::format("all {} increase", t_ns.size()));
  } else {
    const Result<StampRepair> repair = repairStamps(t_ns);
    add(CheckMark::kFail, name + " stamps",
        fmt::format("{}, first in line {}; with --tolerate-stamps: {}",
                    parkade::describe(stream.stamps), lines[stream.stamps.first_row],
                    repair ? parkade::describe(*repair) : repair.error().message));
  }
  if (stream.gaps > 0) {
    add(CheckMark::kWarn, name + " gaps",
        fmt::format("{} of {} steps are longer than {} periods, the longest {:.1f} ms", stream.gaps,
                    t_ns.size() - 1, kGapSteps, stream.largest_gap_ms));
  } else {
    add(CheckMark::kPass, name + " gaps", "none");
  }
}

void Describer::addRateCheck(const std::string& name, const StreamStatistics& stream,
                             double expected_hz) {
  if (expected_hz <= 0.0 || stream.rate_hz <= 0.0) return;
  const bool good = std::abs(stream.rate_hz / expected_hz - 1.0) <= kRateTolerance;
  add(good ? CheckMark::kPass : CheckMark::kWarn, name + " rate",
      fmt::format("{:.4g} Hz, calibration says {:.4g} Hz", stream.rate_hz, expected_hz));
}

void Describer::describeImu() {
  const Result<SensorTable<ImuSample>> table =
      readImuTable(joinPath(sensorFolder(sequence_, "imu0"), "data.csv"));
  if (!table) return add(CheckMark::kFail, "imu0", table.error().message);
  ImuReport imu;
  const std::vector<TimeNs> stamps = table->stamps();
  imu.stream = streamStatistics(stamps);
  for (const std::size_t row : usableRows(stamps)) imu_samples_.push_back(table->rows[row]);
  addStampCheck("imu0", stamps, table->lines, imu.stream);
  if (rig_) addRateCheck("imu0", imu.stream, rig_->imu.rate_hz);
  describeSamples(imu_samples_, rig_ ? rig_->imu.T_vehicle_imu.rotation() : SO3(), imu);
  if (!imu_samples_.empty()) judgeImu(imu);
  report_.imu = imu;
}

void Describer::judgeImu(const ImuReport& imu) {
  const bool good = std::abs(imu.gravity - kGravity) <= kGravityTolerance;
  add(good ? CheckMark::kPass : CheckMark::kWarn, "gravity",
      fmt::format("{:.3f} m/s^2 in the quietest second (spread {:.3f}){}", imu.gravity,
                  imu.quiet_accel_std,
                  good ? ""
                       : fmt::format(", expected {} +- {}: units of g, gravity taken off, or never "
                                     "at rest?",
                                     kGravity, kGravityTolerance)));
  constexpr double kFastest = 6.0;  // rad/s, one sigma of one axis: nothing that carries cameras
  const double turns = imu.gyro_std.maxCoeff();
  add(turns < kFastest ? CheckMark::kPass : CheckMark::kWarn, "gyroscope",
      fmt::format("{:.3g} rad/s (standard deviation of its liveliest axis){}", turns,
                  turns < kFastest ? "" : ": degrees per second?"));
  if (rig_ && rig_->vehicle && imu.gravity > 0.0) {
    const double tilt = std::acos(imu.quiet_accel_vehicle.z() / imu.gravity);
    constexpr double kMaxTilt = 0.26;  // 15 degrees: more than any ramp
    const double tilt_deg = tilt * 180.0 / M_PI;
    add(tilt < kMaxTilt ? CheckMark::kPass : CheckMark::kWarn, "imu0 mounting",
        fmt::format("gravity is {:.1f} deg from the vehicle's vertical{}", tilt_deg,
                    tilt < kMaxTilt ? "" : ": T_vehicle_imu does not fit"));
  }
}

void Describer::describeCameras() {
  if (!rig_) return;
  for (const RigCamera& camera : rig_->cameras) describeCamera(camera);
}

void Describer::describeCamera(const RigCamera& camera) {
  CameraReport camera_report;
  camera_report.name = camera.name;
  camera_report.model = camera.camera.modelName();
  camera_report.width = camera.camera.width();
  camera_report.height = camera.camera.height();
  std::vector<TimeNs>& ordered = image_t_ns_.emplace_back();
  std::vector<std::string>& paths = image_paths_.emplace_back();
  const std::string folder = sensorFolder(sequence_, camera.name);
  const Result<SensorTable<ImageRow>> table = readImageTable(joinPath(folder, "data.csv"));
  if (!table) {
    add(CheckMark::kFail, camera.name, table.error().message);
    report_.cameras.push_back(camera_report);
    return;
  }
  std::vector<TimeNs> stamps = table->stamps();
  for (TimeNs& t_ns : stamps) t_ns += camera.time_offset_ns;
  camera_report.stream = streamStatistics(stamps);
  addStampCheck(camera.name, stamps, table->lines, camera_report.stream);
  addRateCheck(camera.name, camera_report.stream, camera.rate_hz);
  for (const std::size_t row : usableRows(stamps)) ordered.push_back(stamps[row]);
  std::string first_missing;
  for (std::size_t row = 0; row < table->rows.size(); ++row) {
    std::string path = joinPath(joinPath(folder, "data"), table->rows[row].file);
    std::error_code code;
    if (fs::is_regular_file(path, code)) {
      paths.push_back(std::move(path));
    } else if (camera_report.missing++ == 0) {
      first_missing = fmt::format("{} (line {})", path, table->lines[row]);
    }
  }
  if (camera_report.missing > 0) {
    add(paths.empty() ? CheckMark::kFail : CheckMark::kWarn, camera.name + " files",
        fmt::format("{} of {} are missing, the first is {}", camera_report.missing,
                    table->rows.size(), first_missing));
  } else {
    add(CheckMark::kPass, camera.name + " files", fmt::format("all {} are there", paths.size()));
  }
  report_.cameras.push_back(camera_report);
}

void Describer::describeFrames() {
  if (image_t_ns_.empty()) return;
  const TimeNs tolerance = usualJoinTolerance(image_t_ns_);
  const Result<std::vector<JoinedFrame>> frames = joinFrames(image_t_ns_, tolerance);
  if (!frames || frames->empty()) return;
  report_.frame_sets = frames->size();
  std::vector<TimeNs> stamps;
  for (const JoinedFrame& frame : *frames) {
    stamps.push_back(frame.t_ns);
    const bool complete =
        std::find(frame.images.begin(), frame.images.end(), -1) == frame.images.end();
    if (complete) ++report_.complete_frame_sets;
  }
  report_.frame_rate_hz = streamStatistics(stamps).rate_hz;
  const double share =
      static_cast<double>(report_.complete_frame_sets) / static_cast<double>(stamps.size());
  constexpr double kEnough = 0.99;
  add(share >= kEnough ? CheckMark::kPass : CheckMark::kWarn, "frame sets",
      fmt::format("{} of {} have an image of every camera (joined within {:.1f} ms)",
                  report_.complete_frame_sets, report_.frame_sets, toSeconds(tolerance) * 1e3));
  if (!report_.imu) return;
  const StreamStatistics& imu = report_.imu->stream;
  const double early = toSeconds(imu.start_ns - stamps.front());
  const double late = toSeconds(stamps.back() - imu.end_ns);
  const bool covered = early <= 0.0 && late <= 0.0;
  const std::string name = "imu0 covers images";
  if (covered) return add(CheckMark::kPass, name, "yes");
  if (imu.end_ns < stamps.front() || imu.start_ns > stamps.back()) {
    return add(CheckMark::kFail, name,
               fmt::format("not one: samples from {} to {}, images from {} to {} ns: another unit, "
                           "or another clock?",
                           imu.start_ns, imu.end_ns, stamps.front(), stamps.back()));
  }
  add(CheckMark::kWarn, name,
      fmt::format("images run {:.3f} s ahead of the first and {:.3f} s behind the last sample",
                  std::max(0.0, early), std::max(0.0, late)));
}

// Decodes the first image of every camera, or all.
void Describer::describeImages() {
  std::vector<std::pair<std::size_t, std::string>> jobs;
  for (std::size_t camera = 0; camera < image_paths_.size(); ++camera) {
    const auto& paths = image_paths_[camera];
    const std::size_t count =
        options_.decode_images ? paths.size() : std::min<std::size_t>(1, paths.size());
    for (std::size_t i = 0; i < count; ++i) jobs.emplace_back(camera, paths[i]);
  }
  if (jobs.empty()) return;
  constexpr std::size_t kAhead = 16;
  OrderedPrefetch<Result<cv::Mat>> images(
      jobs.size(), [&jobs](std::size_t i) { return readImage(jobs[i].second, true); },
      options_.threads, kAhead);
  std::size_t unreadable = 0;
  std::string first_problem;
  std::string wrong_size;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const Result<cv::Mat> image = images.take();
    CameraReport& camera = report_.cameras[jobs[i].first];
    if (!image) {
      ++camera.unreadable;
      if (unreadable++ == 0) first_problem = image.error().message;
    } else if (wrong_size.empty() &&
               (image->cols != camera.width || image->rows != camera.height)) {
      wrong_size = fmt::format("{}: {} x {}, the calibration is for {} x {}", jobs[i].second,
                               image->cols, image->rows, camera.width, camera.height);
    }
    if (options_.decode_images && options_.progress) {
      options_.progress(static_cast<double>(i + 1) / static_cast<double>(jobs.size()));
    }
  }
  const std::string which = options_.decode_images ? "all" : "the first of each camera";
  if (!wrong_size.empty()) {
    add(CheckMark::kFail, "images", wrong_size);
  } else if (unreadable > 0) {
    add(unreadable == jobs.size() && options_.decode_images ? CheckMark::kFail : CheckMark::kWarn,
        "images",
        fmt::format("{} of {} decoded ({}) are unreadable, the first: {}", unreadable, jobs.size(),
                    which, first_problem));
  } else {
    add(CheckMark::kPass, "images",
        fmt::format("{} decoded ({}), sizes as calibrated", jobs.size(), which));
  }
}

void Describer::describeWheel() {
  const std::string path = joinPath(sensorFolder(sequence_, "wheel0"), "data.csv");
  std::error_code code;
  if (!fs::exists(path, code)) return;
  const Result<SensorTable<WheelSample>> table = readWheelTable(path);
  if (!table) return add(CheckMark::kFail, "wheel0", table.error().message);
  WheelReport wheel;
  const std::vector<TimeNs> stamps = table->stamps();
  wheel.stream = streamStatistics(stamps);
  addStampCheck("wheel0", stamps, table->lines, wheel.stream);
  std::vector<WheelSample> samples;
  for (const std::size_t row : usableRows(stamps)) samples.push_back(table->rows[row]);
  describeWheels(samples, wheel);
  if (rig_ && rig_->vehicle) {
    const auto unit = checkWheelUnit(samples, imu_samples_, rig_->imu.T_vehicle_imu.rotation());
    if (unit) report_.checks.push_back(*unit);
  }
  report_.wheel = wheel;
}

void Describer::describeReference() {
  const Result<std::string> path = findReference(sequence_);
  if (!path) return;  // nothing asks for one
  const Result<TrajectoryFile> file = readTrajectory(*path);
  if (!file) return add(CheckMark::kFail, "reference", file.error().message);
  ReferenceReport reference;
  reference.path = *path;
  reference.count = file->poses.size();
  reference.duration_s = toSeconds(file->poses.back().t_ns - file->poses.front().t_ns);
  reference.length_m = distance(file->poses);
  add(CheckMark::kPass, "reference", fmt::format("{} poses", reference.count));
  report_.reference = reference;
}

void Describer::describeSpan() {
  TimeNs start = std::numeric_limits<TimeNs>::max();
  TimeNs end = std::numeric_limits<TimeNs>::min();
  const auto take = [&start, &end](const StreamStatistics& stream) {
    if (stream.count == 0) return;
    start = std::min(start, stream.start_ns);
    end = std::max(end, stream.end_ns);
  };
  if (report_.imu) take(report_.imu->stream);
  if (report_.wheel) take(report_.wheel->stream);
  for (const CameraReport& camera : report_.cameras) take(camera.stream);
  if (start > end) return;
  report_.start_ns = start;
  report_.end_ns = end;
  report_.duration_s = toSeconds(end - start);
}

}  // namespace

Result<SequenceReport> describeSequence(const std::string& path,
                                        const SequenceReportOptions& options) {
  const Result<std::string> sequence = findSequence(path);
  if (!sequence) return sequence.error();
  return Describer(*sequence, options).describe(path);
}

}  // namespace parkade
