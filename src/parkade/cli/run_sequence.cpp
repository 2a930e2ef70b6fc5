// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/run_sequence.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "parkade/cli/command.hpp"
#include "parkade/cli/interruption.hpp"
#include "parkade/cli/map_path.hpp"
#include "parkade/cli/output_folder.hpp"
#include "parkade/cli/run_folder.hpp"
#include "parkade/cli/run_outputs.hpp"
#ifdef PARKADE_WITH_REPORT
#include "parkade/cli/report_pictures.hpp"
#include "parkade/cli/run_report.hpp"
#endif
#include "parkade/core/log.hpp"
#include "parkade/core/options.hpp"
#include "parkade/core/progress.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/sequence_report.hpp"
#include "parkade/mapping/storage/map_file.hpp"
#include "parkade/pipeline/mapping_run.hpp"

namespace parkade::cli {
namespace {

// Throws what CLI11 throws where the command line is wrong.
Status configure(const RunArguments& arguments, PipelineOptions& options) {
  if (!arguments.config.empty()) {
    Status status = loadOptions(asOptions(options), arguments.config);
    if (!status) return status;
  }
  for (const std::string& assignment : arguments.assignments) {
    const Status status = setOption(asOptions(options), assignment);
    if (!status) {
      throw CLI::ValidationError(status.error().message, CLI::ExitCodes::ValidationError);
    }
  }
  return {};
}

RunMethod methodOf(const std::string& name) {
  if (name == "fused") return RunMethod::kFused;
  if (name == "semantic") return RunMethod::kSemantic;
  return name == "avp-slam" ? RunMethod::kAvpSlam : RunMethod::kVis;
}

// map: file, or folder of the run that made it.
Status locateInMap(const std::string& map, MappingRun& run) {
  const Result<ParkingMap> saved = loadMap(mapFileOf(map));
  if (!saved) return saved.error();
  if (saved->slots.empty()) {
    return Error{fmt::format("{}: holds no slots to find the car by", map)};
  }
  return run.locateIn(*saved);
}

// What can be refused before anything is read.
Status checkFolders(const RunArguments& arguments) {
  if (!arguments.map.empty()) {
    const Status elsewhere = checkMapIsElsewhere(arguments.out, arguments.map);
    if (!elsewhere) return elsewhere;
  }
  if (Status apart = checkIsNoRecording(arguments.out); !apart) return apart;
  if (Status fit = checkRunFolder(arguments.out, arguments.force); !fit) return fit;
  if (arguments.debug_images.empty()) return {};
  if (Status apart = checkIsNoRecording(arguments.debug_images); !apart) return apart;
  return checkOutputFolder(arguments.debug_images, arguments.force);
}

// What 'parkade info' finds wrong with a recording though a run takes it.
void warnOf(const SourceRequest& request) {
  if (request.spec.starts_with("sim:")) return;
  const Result<SequenceReport> report = describeSequence(request.spec);
  if (!report) return;  // the run says so itself
  for (const Check& check : report->checks) {
    if (check.mark != CheckMark::kWarn) continue;
    logWarning("{}: {}: {}", request.spec, check.name, check.detail);
  }
}

// Nothing to say where all went well.
std::string troubleText(const HealthLog& health, const std::string& out) {
  const int degraded = health.frames(Health::kDegraded);
  const int lost = health.frames(Health::kLost);
  if (degraded + lost == 0) return "";
  return fmt::format("{} frame sets degraded, {} lost: why, is in {}\n", degraded, lost,
                     joinPath(out, "health.csv"));
}

constexpr double kNotableTime = 2e-3;  // s, by which a camera's clock or readout is off
constexpr double kSure = 5.0;          // sigmas

// What is to be told of the cameras, with commas between; nothing where all are as told.
template <typename Tell>
std::string ofCameras(const Rig& rig, const std::vector<CameraCalibrationEstimate>& found,
                      const Tell& tell) {
  std::string text;
  for (std::size_t c = 0; c < std::min(found.size(), rig.cameras.size()); ++c) {
    const std::string of_camera = tell(rig.cameras[c], found[c]);
    if (!of_camera.empty()) text += (text.empty() ? "" : ", ") + of_camera;
  }
  return text;
}

// Where pictures are stamped wrongly; nothing where all are right.
std::string clockText(const Rig& rig, const std::vector<CameraCalibrationEstimate>& cameras) {
  const std::string text = ofCameras(rig, cameras, [](const RigCamera& told, const auto& found) {
    const double offset = found.time_offset;
    if (std::abs(offset) < std::max(kNotableTime, kSure * found.sigma(6))) return std::string();
    return fmt::format("{} {:.1f} ms {}", told.name, 1e3 * std::abs(offset),
                       offset < 0.0 ? "late" : "early");
  });
  if (text.empty()) return text;
  // What a rolling shutter does to rows looks like a clock that is off, to a part.
  const bool told = std::any_of(rig.cameras.begin(), rig.cameras.end(),
                                [](const RigCamera& camera) { return camera.readout_time > 0.0; });
  return fmt::format(
      "pictures are stamped {}, by the inertial unit's clock; --rig of the next drive "
      "tells it from the start{}\n",
      text, told ? "" : " (rolling shutters look so, too: tell their readout_time in rig.yaml)");
}

// Where rolling shutters take another time than the rig says; nothing where none does.
std::string shutterText(const Rig& rig, const std::vector<CameraCalibrationEstimate>& cameras) {
  const std::string text = ofCameras(rig, cameras, [](const RigCamera& told, const auto& found) {
    const double off = std::abs(found.readout_time - told.readout_time);
    if (off < std::max(kNotableTime, kSure * found.sigma(7))) return std::string();
    return fmt::format("{} {:.1f} ms ({:.1f} told)", told.name, 1e3 * found.readout_time,
                       1e3 * told.readout_time);
  });
  if (text.empty()) return text;
  return fmt::format("rows are read in {}; --rig of the next drive tells it from the start\n",
                     text);
}

// Where the inertial unit is not as told.
std::string inertialText(double noise_factor) {
  constexpr double kNotable = 1.2;
  if (noise_factor < kNotable) return "";
  return fmt::format(
      "the inertial unit errs {:.1f} times as much as its noise in rig.yaml says, on average: is "
      "it mounted as told there, are its scales right, does it shake?\n",
      noise_factor);
}

Result<OpenedSource> openInput(const RunArguments& arguments, RunMethod method) {
  SourceRequest request = arguments.source;
  request.decode_threads = arguments.threads > 1 ? 1 : 0;
  request.gray = method == RunMethod::kVis;  // networks want colour
  request.gray_beside = method == RunMethod::kFused;
  Result<OpenedSource> opened = openSource(request);
  if (!opened) return opened.error();
  const bool on_wheels = method == RunMethod::kSemantic || method == RunMethod::kAvpSlam;
  if (on_wheels && !opened->source->info().has_wheel) {
    return Error{fmt::format(
        "{}: --method {} needs wheel speeds (mav0/wheel0/data.csv), and there are none; take "
        "--method vis or fused",
        request.spec, arguments.method)};
  }
  return opened;
}

Result<std::unique_ptr<MappingRun>> createRun(const RunArguments& arguments, const Rig& rig,
                                              const PipelineOptions& options, RunMethod method) {
  auto run = MappingRun::create(rig, options, arguments.threads, method);
  if (run && !arguments.map.empty()) {
    if (Status located = locateInMap(arguments.map, **run); !located) return located.error();
  }
  return run;
}

RunDescription describe(const RunArguments& arguments, const OpenedSource& opened,
                        PipelineOptions& options) {
  RunDescription description;
  description.source = arguments.source.spec;
  description.cameras = arguments.source.cameras;
  description.rig = opened.rig;
  for (std::size_t c = 0; c < opened.time_offsets_ns.size(); ++c) {
    description.rig.cameras[c].time_offset_ns = opened.time_offsets_ns[c];
  }
  description.method = arguments.method;
  description.config = dumpOptions(asOptions(options));
  description.threads = arguments.threads;
  return description;
}

Status writeFiles(const std::string& folder, const RunArguments& arguments,
                  const RunDescription& description, const MappingRun& run, const HealthLog& health,
                  const RunTexts& texts) {
  Status status = writeRunFiles(folder, texts, run, health, arguments.with_final);
  if (status) status = writeLearnedRig(folder, description, run);
  if (status) status = writeMap(folder, description.source, run);
  return status;
}

#ifdef PARKADE_WITH_REPORT
Status writePage(const std::string& folder, const MappingRun& run, const ReportPictures& pictures) {
  if (Status drawn = pictures.write(folder); !drawn) return drawn;
  if (run.summary().poses == 0) return {};
  return writeRunReport(folder, joinPath(folder, "report.html"));
}
#endif

// Why a run that went to its end has failed all the same.
Status judge(const RunArguments& arguments, const MappingRun& run) {
  if (run.summary().poses > 0) return {};
  if (!arguments.map.empty() && !run.odometry().empty()) {
    return Error{fmt::format(
        "{}: the car was not found in {}; is it a map of this garage, and of a place that the "
        "drive came by? The odometry's poses are in {}",
        arguments.source.spec, arguments.map, joinPath(arguments.out, "trajectory_vio.tum"))};
  }
  return Error{fmt::format("{}: no pose: the estimator did not start; see the reasons in {}",
                           arguments.source.spec, joinPath(arguments.out, "health.csv"))};
}

Error nothingSeen(const SensorSourceInfo& info) {
  return {fmt::format(
      "{}: no pose: none of {} frame sets could be used: their pictures are missing or cannot be "
      "read, or no reading of the inertial unit follows them; 'parkade info' tells more",
      info.name, info.num_frame_sets)};
}

}  // namespace

Status runSequence(RunArguments arguments) {
  PipelineOptions options;
  if (Status status = configure(arguments, options); !status) return status;
  if (arguments.real_time) {
    options.pace = 1.0;
    options.live = true;
  }
  if (Status status = checkFolders(arguments); !status) return status;
  const RunMethod method = methodOf(arguments.method);
  // The paper's semantic method has one camera: the front one, where the user names no other.
  std::string& cameras = arguments.source.cameras;
  if (method == RunMethod::kSemantic && cameras.empty()) cameras = "cam0";
  Result<OpenedSource> opened = openInput(arguments, method);
  if (!opened) return opened.error();
  auto run = createRun(arguments, opened->rig, options, method);
  if (!run) return run.error();

  HealthLog health;
  (*run)->addObserver(&health);
  std::optional<DebugImages> images;
  if (!arguments.debug_images.empty()) {
    images.emplace(arguments.debug_images, opened->rig);
    if (!images->status()) return images->status();
    (*run)->addObserver(&*images);
  }
  const RunDescription description = describe(arguments, *opened, options);
  warnOf(arguments.source);
  // After all that can go wrong before the run.
  Result<RunFolder> folder = RunFolder::begin(arguments.out, configText(description));
  if (!folder) return folder.error();
  const SensorSourceInfo& info = opened->source->info();
#ifdef PARKADE_WITH_REPORT
  ReportPictures pictures(opened->rig, info.start_ns, info.end_ns, method != RunMethod::kVis);
  (*run)->addObserver(&pictures);
#endif
  ProgressPrinter progress("run");
  const Interruption interruption;
  opened->source = interruptible(std::move(opened->source));
  const Status outcome = (*run)->run(*opened->source, progress.callback());
  progress.finish();
  const RunSummary& summary = (*run)->summary();
  // With nothing to write, an earlier run's results stay.
  if (summary.frame_sets == 0) return outcome ? Status(nothingSeen(info)) : outcome;
  if (Interruption::signal() != 0 && holdsResults(arguments.out)) {
    return Error{fmt::format("{}; the results of the earlier run stay in {}",
                             outcome.error().message, arguments.out)};
  }

  const RunTexts texts = runTexts(description, **run, health);
  Status written = folder->open();
  if (written) {
    written = writeFiles(folder->path(), arguments, description, **run, health, texts);
  }
#ifdef PARKADE_WITH_REPORT
  if (written) written = writePage(folder->path(), **run, pictures);
#endif
  if (!written) return folder->failed(written.error());
  if (Status kept = folder->keep(); !kept) return folder->failed(kept.error());
  fmt::print("{}", timingTable(summary));
  fmt::print("{} frame sets, {} poses, {:.0f} tracks per frame set; wrote {}\n", summary.frame_sets,
             summary.poses, summary.mean_tracks, arguments.out);
  const std::vector<CameraCalibrationEstimate> found = (*run)->calibration();
  fmt::print("{}{}{}{}", troubleText(health, arguments.out), clockText(opened->rig, found),
             shutterText(opened->rig, found), inertialText(health.imuNoiseFactor()));
  if (!outcome) {
    return Error{fmt::format("{} (the poses up to there are in {})", outcome.error().message,
                             arguments.out)};
  }
  if (images && !images->status()) return images->status();
  return judge(arguments, **run);
}

}  // namespace parkade::cli
