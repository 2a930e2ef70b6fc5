// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// The fused poses of recorded drives with a known truth, over and over: pictures are tracked and
// looked at once, and what the mapper was told is kept in a file beside the recording, so that its
// options are judged on many drives within a minute. Poses alone: what is kept has no labels to
// draw a map of. For example
//   parkade_fusion_study SEQ... --variant odometry.yaw_deg=0.002 --variant compass.enable=false
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "binary_cache.hpp"
#include "parkade/io/sequence_reader.hpp"
#include "parkade/pipeline/fused_mapper.hpp"
#include "parkade/pipeline/mapping_run.hpp"
#include "parkade/pipeline/thread_pool.hpp"
#include "parkade/vio/rig_error.hpp"
#include "study_support.hpp"

namespace parkade {
namespace {

struct Arguments {
  std::vector<std::string> sequences;
  std::vector<std::string> run_sets;
  std::vector<std::string> sets;
  std::vector<std::string> variants;
  std::string name = "fusion.bin";
  std::string out;
  bool per_drive = false;
};

/// One call of the mapper: a frame set's odometry, or the features of an earlier one.
struct Step {
  PoseEstimate odometry;
  RigSigma rig_sigma;
  std::optional<SemanticFrame> frame;
};

struct Drive {
  std::string name;
  std::vector<Eigen::Vector3d> viewpoints;
  Trajectory truth;
  std::vector<Step> steps;
  std::set<TimeNs> held;  // frame sets whose features come
  Trajectory odometry;
  double odometry_rmse = 0.0;  // m
};

// Each of these passes a value to a CacheWriter or from a CacheReader.
template <class Cache>
bool pass(Cache& cache, PoseEstimate& e) {
  return cache(e.t_ns) && cache(e.T_odom_vehicle) && cache(e.up_odom) && cache(e.velocity_odom) &&
         cache(e.bias_gyro) && cache(e.bias_accel) && cache(e.covariance) && cache(e.health);
}

template <class Cache>
bool pass(Cache& cache, SlotObservation& s) {
  return cache(s.corners) && cache(s.entrance_covariance) && cache(s.rear_seen) && cache(s.shape) &&
         cache(s.marking) && cache(s.probability_free) && cache(s.seen_over_entrance) &&
         cache(s.confidence);
}

template <class Cache>
bool pass(Cache& cache, ObjectObservation& o) {
  return cache(o.semantic_class) && cache(o.position) && cache(o.covariance) && cache(o.heading) &&
         cache(o.sigma_heading) && cache.all(o.text) && cache.all(o.outline) && cache(o.confidence);
}

template <class Cache>
bool pass(Cache& cache, SemanticFrame& f) {
  return cache(f.labels.t_ns) && cache(f.labels.geometry) && cache(f.attitude) &&
         cache(f.attitude_sigma) && cache(f.rig_turn) && cache.all(f.line_points) &&
         cache.all(f.line_segments) &&
         cache.each(f.slots, [&](SlotObservation& s) { return pass(cache, s); }) &&
         cache.each(f.objects, [&](ObjectObservation& o) { return pass(cache, o); });
}

template <class Cache>
bool pass(Cache& cache, Step& step) {
  bool has_frame = step.frame.has_value();
  if (!pass(cache, step.odometry) || !cache(step.rig_sigma) || !cache(has_frame)) return false;
  if (!has_frame) return true;
  if (!step.frame) step.frame.emplace();
  return pass(cache, *step.frame);
}

/// Keeps what the mapper is told, in its order.
class StepKeeper : public PipelineObserver {
 public:
  explicit StepKeeper(std::vector<Step>& steps) : steps_(steps) {}
  void onPose(const PoseEvent& event) override {
    steps_.push_back({event.odometry, event.rig_sigma, {}});
  }
  void onMap(const MapEvent& event) override {
    Step step;
    step.frame = event.features;
    step.frame->labels.labels.release();
    step.frame->labels.confidence.release();
    step.frame->labels.slot_line.release();
    step.frame->labels.paint.release();
    step.frame->smear.release();
    steps_.push_back(std::move(step));
  }

 private:
  std::vector<Step>& steps_;
};

Status load(const Arguments& arguments, const std::string& path, Drive& drive) {
  drive.name = std::filesystem::path(path).filename().string();
  SequenceReaderOptions colour;
  colour.gray = false;
  colour.gray_beside = true;
  auto reader = SequenceReader::open(path, colour);
  if (!reader) return reader.error();
  for (const RigCamera& camera : (*reader)->rig().cameras) {
    drive.viewpoints.push_back(camera.T_vehicle_cam.translation());
  }
  auto truth = readReference(path);
  if (!truth) return truth.error();
  drive.truth = truth->poses;
  const std::string cache = path + "/" + arguments.name;
  if (std::filesystem::exists(cache)) {
    CacheReader file(cache);
    if (file.each(drive.steps, [&](Step& step) { return pass(file, step); })) return {};
    drive.steps.clear();  // cut off, or another's: driven anew
  }
  PipelineOptions pipeline;
  if (Status status = setAll(pipeline, arguments.run_sets); !status) return status;
  auto run = MappingRun::create((*reader)->rig(), pipeline, 2, RunMethod::kFused);
  if (!run) return run.error();
  StepKeeper keeper(drive.steps);
  (*run)->addObserver(&keeper);
  if (Status done = (*run)->run(**reader); !done) return done;
  CacheWriter file(cache);
  if (!file.each(drive.steps, [&](Step& step) { return pass(file, step); }) || !file.finish()) {
    return Error{cache + ": cannot be written"};
  }
  return {};
}

// What is the same whatever the mapper's options.
void prepare(Drive& drive) {
  for (const Step& step : drive.steps) {
    if (step.frame) {
      drive.held.insert(step.frame->labels.t_ns);
    } else if (step.odometry.health != Health::kInitialising) {
      drive.odometry.push_back({step.odometry.t_ns, step.odometry.T_odom_vehicle});
    }
  }
  drive.odometry_rmse = scorePoses(drive.odometry, {}, drive.truth).rmse;
}

struct Score : PoseScore {
  double odometry = 0.0;  ///< rmse
  int loops = 0;
};

Score judge(const Drive& drive, const FusedMapperOptions& options, const std::string& out) {
  FusedMapper mapper(options, drive.viewpoints);
  Trajectory fused;
  PoseCovariances covariances;
  RigErrorOnWay rig_error;
  for (const Step& step : drive.steps) {
    if (step.frame) {
      mapper.addSemantics(*step.frame, {});
      continue;
    }
    PoseEstimate pose = mapper.addOdometry(step.odometry);
    if (drive.held.count(step.odometry.t_ns) > 0) mapper.holdView();
    if (pose.health == Health::kInitialising) continue;
    rig_error.advance(step.odometry.T_odom_vehicle, pose.T_odom_vehicle, step.rig_sigma);
    rig_error.addTo(pose);
    fused.push_back({pose.t_ns, pose.T_odom_vehicle});
    covariances.push_back({pose.t_ns, pose.covariance.topLeftCorner<6, 6>()});
  }
  if (!out.empty()) {
    writePoses(out + "/" + drive.name + ".tum", fused);
    writePoses(out + "/" + drive.name + "_vio.tum", drive.odometry);
  }
  return {scorePoses(fused, covariances, drive.truth), drive.odometry_rmse,
          mapper.statistics().loops};
}

void print(const std::string& name, const Score& s) {
  fmt::print(
      "  {:<14} fused {:.4f} odometry {:.4f} aligned {:.4f} heading {:.4f} NEES p {:.2f} yaw "
      "{:.2f} loops {}\n",
      name, s.rmse, s.odometry, s.aligned, s.heading_deg, s.nees_position, s.nees_yaw, s.loops);
}

void printMean(const std::string& variant, const std::vector<Score>& scores) {
  Score mean;
  double worst = 0.0;
  int no_worse = 0;
  const double share = 1.0 / static_cast<double>(scores.size());
  for (const Score& s : scores) {
    mean.rmse += share * s.rmse;
    mean.aligned += share * s.aligned;
    mean.heading_deg += share * s.heading_deg;
    mean.odometry += share * s.odometry;
    mean.nees_position += share * s.nees_position;
    mean.nees_yaw += share * s.nees_yaw;
    worst = std::max(worst, s.rmse);
    no_worse += s.rmse <= s.odometry ? 1 : 0;
  }
  fmt::print(
      "fused {:.4f} worst {:.4f} odometry {:.4f} no worse {} of {} aligned {:.4f} heading {:.4f} "
      "NEES p {:.2f} yaw {:.2f}  {}\n",
      mean.rmse, worst, mean.odometry, no_worse, scores.size(), mean.aligned, mean.heading_deg,
      mean.nees_position, mean.nees_yaw, variant.empty() ? "as it is" : variant);
  std::fflush(stdout);
}

int study(const Arguments& arguments) {
  FusedMapperOptions base;
  std::vector<FusedMapperOptions> variants;
  Status status = setAll(base, arguments.sets);
  for (const std::string& variant : arguments.variants) {
    if (!status) break;
    variants.push_back(base);
    status = setAll(variants.back(), CLI::detail::split(variant, ','));
  }
  std::vector<std::string> names = {""};
  names.insert(names.end(), arguments.variants.begin(), arguments.variants.end());
  variants.insert(variants.begin(), base);
  std::vector<Drive> drives(arguments.sequences.size());
  for (std::size_t i = 0; status && i < drives.size(); ++i) {
    status = load(arguments, arguments.sequences[i], drives[i]);
    prepare(drives[i]);
  }
  if (!status) {
    fmt::print(stderr, "{}\n", status.error().message);
    return 1;
  }
  ThreadPool pool(1);
  for (std::size_t k = 0; k < variants.size(); ++k) {
    std::vector<Score> scores(drives.size());
    pool.parallelFor(static_cast<int>(drives.size()), [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      scores[at] = judge(drives[at], variants[k], k == 0 ? arguments.out : "");
    });
    printMean(names[k], scores);
    for (std::size_t i = 0; arguments.per_drive && i < drives.size(); ++i) {
      print(drives[i].name, scores[i]);
    }
  }
  return 0;
}

}  // namespace
}  // namespace parkade

int main(int argc, char** argv) {
  parkade::Arguments arguments;
  CLI::App app("Fused poses of recorded drives with a known truth, their pictures looked at once");
  app.add_option("sequences", arguments.sequences, "Folders of recordings")->required();
  app.add_option("--set", arguments.sets, "An option of the mapper, as odometry.yaw_deg=0.003");
  app.add_option("--variant", arguments.variants,
                 "Also with such options, as odometry.yaw_deg=0.002,compass.sigma_deg=0.3; may be "
                 "repeated");
  app.add_option(
      "--run-set", arguments.run_sets,
      "An option of the run that looks at pictures, as vio.window.keyframes=8; give it a "
      "--name of its own, for a file that is there is read as it is");
  app.add_option("--name", arguments.name, "File kept in each folder")->capture_default_str();
  app.add_option("--out", arguments.out, "Write the trajectories of the first into this folder");
  app.add_flag("--drives", arguments.per_drive, "Print every drive, not the mean alone");
  CLI11_PARSE(app, argc, argv);
  return parkade::study(arguments);
}
