// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// The odometry on recorded drives with a known truth, over and over: pictures are tracked once and
// the tracks kept in a file beside the recording, so that an option of the estimator is judged on
// many drives within a minute. For example
//   parkade_odometry_study SEQ... --set window.keyframes=8 --set imu_noise_factor=1
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <filesystem>
#include <opencv2/core/utility.hpp>
#include <string>
#include <vector>

#include "binary_cache.hpp"
#include "parkade/core/random.hpp"
#include "parkade/core/units.hpp"
#include "parkade/eval/association.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/sequence_files.hpp"
#include "parkade/io/sequence_reader.hpp"
#include "parkade/pipeline/mapping_run.hpp"
#include "parkade/vio/rig_error.hpp"
#include "study_support.hpp"

namespace parkade {
namespace {

struct Arguments {
  std::vector<std::string> sequences;
  std::vector<std::string> sets;
  std::vector<std::string> tracking;
  std::string name = "tracks.bin";
  std::string out;
  std::vector<double> calib_error;
  int repeat = 1;
  bool read_imu = false;
  bool per_drive = false;
};

struct Drive {
  std::string path;
  Rig rig;
  Trajectory truth;
  std::vector<ImuSample> imu;
  std::vector<WheelSample> wheel;
  std::vector<TrackSet> frames;
};

template <class Cache>
bool pass(Cache& cache, TrackSet& tracks) {
  return cache(tracks.t_ns) && cache.all(tracks.camera_ok) && cache.all(tracks.observations);
}

template <class Cache>
bool pass(Cache& cache, Drive& drive) {
  return cache.all(drive.imu) && cache.all(drive.wheel) &&
         cache.each(drive.frames, [&](TrackSet& tracks) { return pass(cache, tracks); });
}

/// Passes a source on and keeps its inertial readings.
class ListeningSource : public SensorSource {
 public:
  ListeningSource(SensorSource& source, Drive& drive) : source_(source), drive_(drive) {}
  [[nodiscard]] const SensorSourceInfo& info() const override { return source_.info(); }
  Result<std::optional<SensorEvent>> next() override {
    Result<std::optional<SensorEvent>> event = source_.next();
    if (event && event->has_value()) {
      if (const auto* imu = std::get_if<ImuSample>(&**event)) drive_.imu.push_back(*imu);
      if (const auto* wheel = std::get_if<WheelSample>(&**event)) drive_.wheel.push_back(*wheel);
    }
    return event;
  }

 private:
  SensorSource& source_;
  Drive& drive_;
};

class TrackKeeper : public PipelineObserver {
 public:
  explicit TrackKeeper(Drive& drive) : drive_(drive) {}
  void onTracks(const TracksEvent& event) override { drive_.frames.push_back(event.tracks); }

 private:
  Drive& drive_;
};

Status load(const Arguments& arguments, Drive& drive) {
  SequenceReaderOptions options;
  auto reader = SequenceReader::open(drive.path, options);
  if (!reader) return reader.error();
  drive.rig = (*reader)->rig();
  auto truth = readReference(drive.path);
  if (!truth) return truth.error();
  drive.truth = truth->poses;
  const std::string cache = drive.path + "/" + arguments.name;
  if (std::filesystem::exists(cache)) {
    CacheReader file(cache);
    if (pass(file, drive)) {
      if (!arguments.read_imu) return {};
      auto readings = readImuTable(joinPath(sensorFolder(drive.path, "imu0"), "data.csv"));
      if (!readings) return readings.error();
      drive.imu = std::move(readings->rows);
      return {};
    }
    drive.frames.clear();  // cut off, or another's: tracked anew
    drive.imu.clear();
    drive.wheel.clear();
  }
  PipelineOptions pipeline;
  if (Status status = setAll(pipeline, arguments.tracking); !status) return status;
  auto run = MappingRun::create(drive.rig, pipeline, 2);
  if (!run) return run.error();
  ListeningSource source(**reader, drive);
  TrackKeeper keeper(drive);
  (*run)->addObserver(&keeper);
  if (Status done = (*run)->run(source); !done) return done;
  CacheWriter file(cache);
  if (!pass(file, drive) || !file.finish()) return Error{cache + ": cannot be written"};
  return {};
}

// A rig whose cameras are told wrong about and along each axis (standard deviations, rad and m).
Rig disturbed(Rig rig, double rotation, double position, std::uint64_t seed) {
  Random random(seed);
  const auto normals = [&] {
    const double x = random.normal();
    const double y = random.normal();
    return Eigen::Vector3d(x, y, random.normal());
  };
  for (RigCamera& camera : rig.cameras) {
    const Eigen::Vector3d turn = rotation * normals();
    camera.T_vehicle_cam.rotation() = camera.T_vehicle_cam.rotation() * SO3::exp(turn);
    camera.T_vehicle_cam.translation() += position * normals();
  }
  return rig;
}

// Tracks as they would be of all but the same pictures: rounding alone moves a drive by
// centimetres, so options are told apart by the means of several.
void shake(std::vector<TrackSet>& frames, std::uint64_t seed) {
  constexpr double kShakePx = 0.02;
  Random random(seed);
  for (TrackSet& tracks : frames) {
    for (TrackObservation& o : tracks.observations) {
      o.pixel.x() += kShakePx * random.normal();
      o.pixel.y() += kShakePx * random.normal();
    }
  }
}

/// Squares of what headings and places change against the truth over a stretch.
struct Stretch {
  double seconds;
  double heading_squares = 0.0;
  double along_squares = 0.0;
  double across_squares = 0.0;
  int count = 0;
};

struct Score : PoseScore {
  double ms = 0.0;
  std::array<Stretch, 3> stretches{Stretch{1.0}, Stretch{5.0}, Stretch{15.0}};
};

void addStretches(const Trajectory& estimate, const Trajectory& truth, Score& score) {
  AssociationOptions how;
  how.interpolate = true;
  const auto pairs = associate(estimate, truth, how);
  if (!pairs) return;
  for (Stretch& stretch : score.stretches) {
    std::size_t from = 0;
    const Trajectory& ours = pairs->estimate;
    for (std::size_t to = 1; to < pairs->size(); ++to) {
      if (toSeconds(ours[to].t_ns - ours[from].t_ns) < stretch.seconds) continue;
      const SE3 moved = ours[from].T_world_body.inverse() * ours[to].T_world_body;
      const SE3 really =
          pairs->reference[from].T_world_body.inverse() * pairs->reference[to].T_world_body;
      from = to;
      if (really.translation().norm() < 0.5 * stretch.seconds) continue;  // at rest, about
      const SE3 error = really.inverse() * moved;
      stretch.heading_squares += std::pow(SE2::fromSE3(error).angle() / kDegree, 2.0);
      stretch.along_squares += std::pow(error.translation().x(), 2.0);
      stretch.across_squares += std::pow(error.translation().y(), 2.0);
      ++stretch.count;
    }
  }
}

void add(const Score& score, Score& sum) {
  sum.rmse += score.rmse;
  sum.aligned += score.aligned;
  sum.heading_deg += score.heading_deg;
  sum.nees_position += score.nees_position;
  sum.nees_yaw += score.nees_yaw;
  sum.ms += score.ms;
  for (std::size_t k = 0; k < sum.stretches.size(); ++k) {
    sum.stretches[k].heading_squares += score.stretches[k].heading_squares;
    sum.stretches[k].along_squares += score.stretches[k].along_squares;
    sum.stretches[k].across_squares += score.stretches[k].across_squares;
    sum.stretches[k].count += score.stretches[k].count;
  }
}

Score judge(const Drive& drive, const VioOptions& options, const std::string& out) {
  VioEstimator estimator(drive.rig, options);
  Trajectory estimate;
  PoseCovariances covariances;
  RigErrorOnWay rig_error;
  std::size_t next = 0;
  const std::int64_t begin = cv::getTickCount();
  std::size_t wheel = 0;
  for (const TrackSet& tracks : drive.frames) {
    while (next < drive.imu.size() && drive.imu[next].t_ns <= tracks.t_ns) {
      estimator.addImu(drive.imu[next++]);
    }
    if (next < drive.imu.size()) estimator.addImu(drive.imu[next++]);
    while (wheel < drive.wheel.size() && drive.wheel[wheel].t_ns <= tracks.t_ns) {
      estimator.addWheel(drive.wheel[wheel++]);
    }
    PoseEstimate pose = estimator.addTracks(tracks);
    if (pose.health == Health::kInitialising) continue;
    rig_error.advance(pose.T_odom_vehicle, pose.T_odom_vehicle, estimator.rigSigma());
    rig_error.addTo(pose);  // as a run tells it
    estimate.push_back({pose.t_ns, pose.T_odom_vehicle});
    covariances.push_back({pose.t_ns, pose.covariance.topLeftCorner<6, 6>()});
  }
  const double ms = 1e3 * static_cast<double>(cv::getTickCount() - begin) / cv::getTickFrequency() /
                    static_cast<double>(drive.frames.size());
  Score score{scorePoses(estimate, covariances, drive.truth)};
  score.ms = ms;
  addStretches(estimate, drive.truth, score);
  if (!out.empty()) {
    const std::string name = std::filesystem::path(drive.path).filename().string();
    writePoses(out + "/" + name + ".tum", estimate);
  }
  return score;
}

void print(const std::string& name, const Score& s) {
  fmt::print("{:<14} rmse {:.4f} aligned {:.4f} heading {:.4f} NEES p {:5.2f} yaw {:5.2f} ", name,
             s.rmse, s.aligned, s.heading_deg, s.nees_position, s.nees_yaw);
  for (const Stretch& stretch : s.stretches) {
    const double n = std::max(stretch.count, 1);
    fmt::print("| {:.0f} s: {:.4f} deg {:.1f} {:.1f} mm ", stretch.seconds,
               std::sqrt(stretch.heading_squares / n), 1e3 * std::sqrt(stretch.along_squares / n),
               1e3 * std::sqrt(stretch.across_squares / n));
  }
  fmt::print("| {:.1f} ms\n", s.ms);
  std::fflush(stdout);
}

int study(const Arguments& arguments) {
  VioOptions options;
  if (const Status status = setAll(options, arguments.sets); !status) {
    fmt::print(stderr, "{}\n", status.error().message);
    return 2;
  }
  Score sum;
  int drives = 0;
  double worst = 0.0;
  for (const std::string& path : arguments.sequences) {
    Drive drive;
    drive.path = path;
    if (const Status status = load(arguments, drive); !status) {
      fmt::print(stderr, "{}\n", status.error().message);
      return 1;
    }
    if (arguments.calib_error.size() == 2) {
      drive.rig =
          disturbed(drive.rig, arguments.calib_error[0] * kDegree, 0.01 * arguments.calib_error[1],
                    static_cast<std::uint64_t>(drives / arguments.repeat));
    }
    const std::vector<TrackSet> tracked = drive.frames;
    for (int again = 0; again < arguments.repeat; ++again) {
      if (again > 0) {
        drive.frames = tracked;
        shake(drive.frames, static_cast<std::uint64_t>(again));
      }
      const Score score = judge(drive, options, again == 0 ? arguments.out : "");
      if (arguments.per_drive) print(std::filesystem::path(path).filename().string(), score);
      ++drives;
      worst = std::max(worst, score.rmse);
      add(score, sum);
    }
  }
  for (double* value :
       {&sum.rmse, &sum.aligned, &sum.heading_deg, &sum.nees_position, &sum.nees_yaw, &sum.ms}) {
    *value /= drives;
  }
  print(fmt::format("mean of {}", drives), sum);
  fmt::print("worst rmse {:.4f}\n", worst);
  return 0;
}

}  // namespace
}  // namespace parkade

int main(int argc, char** argv) {
  parkade::Arguments arguments;
  CLI::App app("Odometry on recorded drives with a known truth, their pictures tracked once");
  app.add_option("sequences", arguments.sequences, "Folders of recordings")->required();
  app.add_option("--set", arguments.sets, "An option of the estimator, as window.keyframes=8");
  app.add_option("--tracking-set", arguments.tracking,
                 "An option of the run that tracks, as tracking.detection.features=200; give it a "
                 "--tracks file of its own, for one that is there is read as it is");
  app.add_option("--tracks", arguments.name, "File of the tracks in each folder")
      ->capture_default_str();
  app.add_option("--calib-error", arguments.calib_error,
                 "Tell the estimator a rig that is wrong by DEG,CM, another for each drive")
      ->delimiter(',')
      ->expected(2);
  app.add_option("--repeat", arguments.repeat,
                 "Judge each drive so often, its tracks shaken by 0.02 px")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_flag("--read-imu", arguments.read_imu,
               "Inertial readings of mav0/imu0 instead of those kept with the tracks, as of copies "
               "that tools/damage_recording.py made");
  app.add_option("--out", arguments.out, "Write the trajectories into this folder");
  app.add_flag("--drives", arguments.per_drive, "Print every drive, not the mean alone");
  CLI11_PARSE(app, argc, argv);
  return parkade::study(arguments);
}
