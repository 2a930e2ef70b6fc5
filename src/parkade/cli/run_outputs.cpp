// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/run_outputs.hpp"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "parkade/cli/learned_rig.hpp"
#include "parkade/cli/output_folder.hpp"
#include "parkade/cli/run_folder.hpp"
#include "parkade/core/json_text.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/io/pose_covariance_io.hpp"
#include "parkade/io/trajectory_io.hpp"
#include "parkade/mapping/storage/map_drawing.hpp"
#include "parkade/mapping/storage/map_export.hpp"
#include "parkade/mapping/storage/map_file.hpp"
#include "parkade/tracking/draw_tracks.hpp"

namespace parkade::cli {
namespace {

nlohmann::json timingJson(const RunSummary& summary) {
  nlohmann::json json;
  json["stages"] = nlohmann::json::object();
  for (const StageTiming& stage : summary.stages) {
    json["stages"][stage.name] = {{"mean_ms", stage.mean_ms},
                                  {"p50_ms", stage.p50_ms},
                                  {"p95_ms", stage.p95_ms},
                                  {"max_ms", stage.max_ms},
                                  {"count", stage.count}};
  }
  json["recorded_s"] = summary.recorded_s;
  json["processing_s"] = summary.processing_s;
  json["reading_s"] = summary.reading_s;
  json["wall_s"] = summary.wall_s;
  json["real_time_factor"] =
      summary.recorded_s > 0.0 ? summary.processing_s / summary.recorded_s : 0.0;
  json["peak_memory_mb"] = peakMemoryMb();
  json["pictures_passed_over"] = summary.pictures_passed_over;
  json["frame_sets_passed_over"] = summary.frame_sets_passed_over;
  return json;
}

nlohmann::json metricsJson(const RunDescription& description, const MappingRun& run,
                           const HealthLog& health) {
  const RunSummary& summary = run.summary();
  nlohmann::json json;
  json["source"] = description.source;
  json["method"] = description.method;
  json["frame_sets"] = summary.frame_sets;
  json["poses"] = summary.poses;
  json["coverage"] =
      summary.frame_sets > 0 ? static_cast<double>(summary.poses) / summary.frame_sets : 0.0;
  json["path_length_m"] = pathLength(run.trajectory());
  json["mean_tracks"] = summary.mean_tracks;
  json["images"] = summary.images;
  json["pictures_repeated"] = summary.pictures_repeated;
  json["imu_noise_factor"] = health.imuNoiseFactor();
  for (const Health h :
       {Health::kInitialising, Health::kTracking, Health::kDegraded, Health::kLost}) {
    json["health"][toString(h)] = health.frames(h);
  }
  const std::vector<CameraCalibrationEstimate> calibration = run.calibration();
  for (std::size_t c = 0; c < calibration.size(); ++c) {
    json["calibration"].push_back(calibrationJson(description.rig.cameras[c], calibration[c]));
  }
  const std::optional<double> start_up = health.startUpSeconds();
  json["start_up_s"] = start_up ? nlohmann::json(*start_up) : nlohmann::json();
  return json;
}

// Of an earlier run, which may have been longer.
void removeTrackPictures(const std::string& folder) {
  std::error_code code;
  std::vector<std::filesystem::path> earlier;
  for (const auto& entry : std::filesystem::directory_iterator(folder, code)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == ".jpg" && name.size() == 6 &&
        name.find_first_not_of("0123456789") == std::string::npos) {
      earlier.push_back(entry.path());
    }
  }
  for (const std::filesystem::path& picture : earlier) std::filesystem::remove(picture, code);
}

}  // namespace

std::string configText(const RunDescription& description) {
  return fmt::format("{}; --config reads it.\n# source: {}\n# method: {}, cameras: {}\n{}",
                     kRunConfigHeading, description.source, description.method,
                     description.cameras.empty() ? "all" : description.cameras, description.config);
}

HealthLog::HealthLog()
    : text_(
          "t,health,reason,tracks,sigma_position_m,sigma_yaw_deg,vx,vy,vz,bias_gyro_x,bias_gyro_y,"
          "bias_gyro_z,bias_accel_x,bias_accel_y,bias_accel_z,keyframes,landmarks,standstill\n") {}

void HealthLog::onPose(const PoseEvent& event) {
  const PoseEstimate& e = event.estimate;
  // Right perturbation: the world's vertical in the vehicle frame picks the yaw.
  const Eigen::Vector3d up = e.T_odom_vehicle.rotation().inverse() * Eigen::Vector3d::UnitZ();
  const double position = std::sqrt(std::max(0.0, e.covariance.topLeftCorner<3, 3>().trace()));
  const double yaw = std::sqrt(std::max(0.0, up.dot(e.covariance.block<3, 3>(3, 3) * up)));
  std::string reason = e.reason;
  for (char& c : reason) {
    if (c == ',' || c == '\n' || c == '"') c = ';';
  }
  text_ += fmt::format(
      "{}.{:09d},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},"
      "{:.6g},{},{},{}\n",
      e.t_ns / kNsPerSecond, e.t_ns % kNsPerSecond, toString(e.health), reason, event.num_tracks,
      position, yaw * 180.0 / M_PI, e.velocity_odom.x(), e.velocity_odom.y(), e.velocity_odom.z(),
      e.bias_gyro.x(), e.bias_gyro.y(), e.bias_gyro.z(), e.bias_accel.x(), e.bias_accel.y(),
      e.bias_accel.z(), event.statistics.keyframes, event.statistics.landmarks,
      event.statistics.standstill ? 1 : 0);
  if (frames_[0] + frames_[1] + frames_[2] + frames_[3] == 0) first_t_ns_ = e.t_ns;
  ++frames_[static_cast<int>(e.health)];
  if (e.health == Health::kInitialising) return;
  covariances_.push_back({e.t_ns, e.covariance.topLeftCorner<6, 6>()});
  if (!first_pose_t_ns_) first_pose_t_ns_ = e.t_ns;
  imu_noise_factors_ += event.statistics.imu_noise_factor;
}

double HealthLog::imuNoiseFactor() const {
  if (covariances_.empty()) return 1.0;
  return imu_noise_factors_ / static_cast<double>(covariances_.size());
}

std::optional<double> HealthLog::startUpSeconds() const {
  if (!first_pose_t_ns_) return std::nullopt;
  return toSeconds(*first_pose_t_ns_ - first_t_ns_);
}

DebugImages::DebugImages(std::string folder, Rig rig)
    : folder_(std::move(folder)), rig_(std::move(rig)), status_(makeWritable(folder_)) {
  if (status_) removeTrackPictures(folder_);
}

void DebugImages::onTracks(const TracksEvent& event) {
  if (!status_) return;
  const std::string caption = fmt::format(
      "frame {}  t {}.{:03d}  {} observations  {} new  {} matched  {} lost  {} new patches  prior "
      "{}",
      event.frames.index, event.frames.t_ns / kNsPerSecond,
      event.frames.t_ns % kNsPerSecond / kNsPerMs, event.tracks.observations.size(),
      event.report.detected, event.report.matched.size(), event.report.lost.size(),
      event.report.renewed,
      !event.prior.valid ? "none" : (event.prior.translation_valid ? "motion" : "rotation"));
  const cv::Mat picture =
      drawTracks(event.frames, event.tracks, previous_, event.report, event.prior, rig_, caption);
  ImageEncoding encoding;
  encoding.jpeg_quality = 85;
  status_ = writeImage(joinPath(folder_, fmt::format("{:06d}.jpg", event.frames.index)), picture,
                       encoding);
  previous_ = event.tracks;
}

RunTexts runTexts(const RunDescription& description, const MappingRun& run,
                  const HealthLog& health) {
  return {{"health.csv", health.text()},
          {"timing.json", jsonText(timingJson(run.summary()))},
          {"metrics.json", jsonText(metricsJson(description, run, health))}};
}

Status writeRunFiles(const std::string& folder, const RunTexts& texts, const MappingRun& run,
                     const HealthLog& health, bool with_final) {
  const auto path = [&](const char* name) { return joinPath(folder, name); };
  Status written =
      writeTrajectory(path("trajectory.tum"), run.trajectory(), TrajectoryFormat::kTum);
  if (!written) return written;
  written = writeTrajectory(path("trajectory_vio.tum"), run.odometry(), TrajectoryFormat::kTum);
  if (!written) return written;
  written = writePoseCovariances(path("covariance.csv"), health.covariances());
  if (!written) return written;
  if (with_final) {
    Status status = writeTrajectory(path("trajectory_final.tum"), run.finalTrajectory(),
                                    TrajectoryFormat::kTum);
    if (!status) return status;
  }
  for (const auto& [name, text] : texts) {
    Status status = writeFileAtomic(joinPath(folder, name), text);
    if (!status) return status;
  }
  return {};
}

Status writeLearnedRig(const std::string& folder, const RunDescription& description,
                       const MappingRun& run) {
  const std::vector<CameraCalibrationEstimate> learned = run.calibration();
  const std::vector<RigCamera>& told = description.rig.cameras;
  const bool has_files = std::all_of(
      told.begin(), told.end(), [](const RigCamera& camera) { return camera.mask_pixels.empty(); });
  if (learned.empty() || !has_files || run.summary().poses == 0) return {};
  return writeRig(learnedRig(description.rig, learned), joinPath(folder, "rig.yaml"));
}

Status writeMap(const std::string& folder, const std::string& name, const MappingRun& run) {
  if (run.mapper() == nullptr) return {};
  ParkingMap map = run.mapper()->map(name);
  if (Status saved = saveMap(map, joinPath(folder, "map.db")); !saved) return saved;
  const std::string exports = joinPath(folder, "map");
  if (Status made = makeFolders(exports); !made) return made;
  for (const GridLayer layer : kGridLayers) {
    if (Status status = exportNav2(map, layer, exports); !status) return status;
  }
  if (Status s = exportGeoJson(map, joinPath(exports, "map.geojson")); !s) return s;
  if (Status s = exportLanelet2(map, joinPath(exports, "map.osm")); !s) return s;
  const Result<cv::Mat> picture = drawMap(map);
  if (!picture) return picture.error();
  ImageEncoding png;
  png.png = true;
  return writeImage(joinPath(exports, "map.png"), *picture, png);
}

std::string timingTable(const RunSummary& summary) {
  std::string text = fmt::format("{:<12}{:>10}{:>10}{:>10}{:>10}{:>8}\n", "stage", "mean ms",
                                 "p50 ms", "p95 ms", "max ms", "count");
  for (const StageTiming& s : summary.stages) {
    text += fmt::format("{:<12}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}{:>8}\n", s.name, s.mean_ms,
                        s.p50_ms, s.p95_ms, s.max_ms, s.count);
  }
  text += fmt::format(
      "recorded {:.2f} s, processing {:.2f} s, waiting for images {:.2f} s; real-time factor "
      "{:.3f}; peak memory {:.0f} MB\n",
      summary.recorded_s, summary.processing_s, summary.reading_s,
      summary.recorded_s > 0.0 ? summary.processing_s / summary.recorded_s : 0.0, peakMemoryMb());
  if (summary.pictures_passed_over > 0) {
    text += fmt::format(
        "the computer did not keep up: {} of {} frame sets were passed over by the semantic part\n",
        summary.pictures_passed_over, summary.frame_sets);
  }
  if (summary.pictures_repeated > 0) {
    text += fmt::format(
        "{} pictures were the camera's last one again though the car moved, and were left out\n",
        summary.pictures_repeated);
  }
  if (summary.frame_sets_passed_over > 0) {
    text += fmt::format(
        "it lagged behind: {} frame sets were passed over altogether; fewer or smaller pictures, "
        "or more cores, help\n",
        summary.frame_sets_passed_over);
  }
  return text;
}

double peakMemoryMb() {
  // Of this program alone: ru_maxrss also counts what its parent held when it started it.
  const Result<std::string> status = readFile("/proc/self/status");
  const std::string kPeak = "VmHWM:";
  const std::size_t at = status ? status->find(kPeak) : std::string::npos;
  if (at != std::string::npos) {
    return std::strtod(status->c_str() + at + kPeak.size(), nullptr) / 1024.0;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace parkade::cli
