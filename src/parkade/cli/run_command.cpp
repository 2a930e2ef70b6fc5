// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "parkade/cli/command.hpp"
#include "parkade/cli/interruption.hpp"
#include "parkade/cli/map_path.hpp"
#include "parkade/cli/open_source.hpp"
#include "parkade/cli/option_checks.hpp"
#include "parkade/cli/output_folder.hpp"
#include "parkade/cli/run_methods.hpp"
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

struct RunArguments {
  SourceRequest source;
  std::string out;
  std::string method = "vis";
  std::string map;
  std::string config;
  std::vector<std::string> assignments;
  std::string debug_images;
  bool with_final = false;
  bool force = false;
  int threads = 2;
  bool real_time = false;
};

constexpr const char* kRunFooter =
    "SEQ is a sequence folder (docs/formats.md). OUT then holds\n"
    "  trajectory.tum        one pose per frame set from the start on, as known at its instant\n"
    "  trajectory_vio.tum    the odometry's poses; with --final also trajectory_final.tum\n"
    "  covariance.csv        the covariance of every pose\n"
    "  health.csv            one row per frame set: health and its reason, speed, biases\n"
    "  map.db, map/          the map and its exports, where the method makes one (not vis)\n"
    "  report.html           a page about the run; pictures/ holds what it shows\n"
    "  rig.yaml              the rig with its cameras where the drive found them, for --rig\n"
    "  timing.json, metrics.json, config.yaml\n"
    "With --map all poses are in the map's frame, and trajectory.tum begins where the car is found "
    "in\n"
    "it. The results of an earlier run in OUT are replaced with --force only, once the new ones "
    "are\n"
    "there.\n"
    "\n"
    "'parkade run --help-options' lists every option that --set and --config take.\n"
    "\n"
    "Examples:\n"
    "  parkade run SEQ --out OUT\n"
    "  parkade run SEQ --out FRONT --cameras cam0 --set vio.window.keyframes=8 --final\n"
    "  parkade run SEQ --out FUSED --method fused\n"
    "  parkade run LATER --out OUT2 --method fused --map FUSED --rig FUSED\n"
    "  parkade run SEQ --out SHORT --duration 5 --debug-images SHORT/tracks";

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
  for (const SequenceCheck& check : report->checks) {
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

Status writeResults(const RunArguments& arguments, const RunDescription& description,
                    const MappingRun& run, const HealthLog& health) {
  const std::string& out = arguments.out;
  const RunTexts texts = runTexts(description, run, health);
  Status status = clearRunFolder(out, configText(description));
  if (status) status = writeRunFiles(out, texts, run, health, arguments.with_final);
  if (status) status = writeLearnedRig(out, description, run);
  if (status) status = writeMap(out, description.source, run);
  return status;
}

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
  Status begun = beginRunFolder(arguments.out, configText(description));
  if (!begun) return begun;
  const SensorSourceInfo& info = opened->source->info();
#ifdef PARKADE_WITH_REPORT
  ReportPictures pictures(arguments.out, opened->rig, info.start_ns, info.end_ns,
                          method != RunMethod::kVis);
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

  const Status written = writeResults(arguments, description, **run, health);
  if (!written) return written;
#ifdef PARKADE_WITH_REPORT
  if (Status drawn = pictures.finish(); !drawn) return drawn;
  if (summary.poses > 0) {
    const Status page = writeRunReport(arguments.out, joinPath(arguments.out, "report.html"));
    if (!page) return page;
  }
#endif
  fmt::print("{}", timingTable(summary));
  fmt::print("{} frame sets, {} poses, {:.0f} tracks per frame set; wrote {}\n", summary.frame_sets,
             summary.poses, summary.mean_tracks, arguments.out);
  fmt::print("{}", troubleText(health, arguments.out));
  if (!outcome) {
    return Error{fmt::format("{} (the poses up to there are in {})", outcome.error().message,
                             arguments.out)};
  }
  if (images && !images->status()) return images->status();
  return judge(arguments, **run);
}

}  // namespace

void addRunCommand(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("run", "Localise and map: read a sequence, write a run");
  const auto a = std::make_shared<RunArguments>();
  command->add_option("SEQ", a->source.spec, "Sequence folder, or sim:GARAGE/ROUTE")->required();
  command->add_option("-o,--out", a->out, "Folder to write, made where it is not there")
      ->required();
  command
      ->add_option(
          "--method", a->method,
          "fused (key points and semantics), vis (key points only), semantic (one camera's "
          "markings, wheels and gyroscope), avp-slam (that scheme; surround markings, "
          "wheels and gyroscope)")
      ->check(CLI::IsMember(kRunMethods))
      ->capture_default_str();
  command->add_option(
      "--map", a->map,
      "Find the car in this saved map (map.db, or the run's folder) and localise in "
      "it: all poses are the map's");
  command->add_flag("--final", a->with_final,
                    "Also write trajectory_final.tum: every pose with all that came after it");
  command->add_flag(
      "--force", a->force,
      "Replace the results of an earlier run in OUT, or write into a folder that holds "
      "something else");

  command
      ->add_option("--rig", a->source.rig,
                   "Rig file in place of SEQ's rig.yaml, or the folder of a run: the rig as that "
                   "drive found it")
      ->group("Input");
  command->add_option("--cameras", a->source.cameras, "Cameras to use, as cam0,cam1; default: all")
      ->check(checkCameraNames)
      ->group("Input");
  command->add_option("--start", a->source.start_s, "Skip this much of the sequence, s")
      ->check(notNegative())
      ->capture_default_str()
      ->group("Input");
  command->add_option("--duration", a->source.duration_s, "Stop after this much, s; 0: at the end")
      ->check(notNegative())
      ->capture_default_str()
      ->group("Input");
  command
      ->add_option("--join-tolerance", a->source.join_tolerance_ms,
                   "Images of different cameras this close are one instant, ms; at most half a "
                   "period (default: 5, or half a period where less)")
      ->check(CLI::Range(0.0, 1000.0))
      ->group("Input");
  command
      ->add_flag("--tolerate-stamps", a->source.tolerate_stamps,
                 "Repair stamps that go backwards or repeat instead of refusing the sequence")
      ->group("Input");

  command->add_option("--config", a->config, "YAML file of options, such as a run's config.yaml")
      ->group("Options");
  command
      ->add_option("--set", a->assignments,
                   "One option, as vio.window.keyframes=8; may be repeated; beats --config")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->group("Options");
  command
      ->add_flag_callback(
          "--help-options",
          [] {
            PipelineOptions options;
            fmt::print("Options for --set and --config: name, default, meaning [range]\n\n{}",
                       describeOptions(asOptions(options)));
            throw CLI::Success();
          },
          "List all options with their defaults and exit")
      ->group("Options");

  command
      ->add_flag("--real-time", a->real_time,
                 "Take frame sets when they are due by their stamps, as from a car, and pass "
                 "pictures over where the computer does not keep up, for the map or altogether: "
                 "latencies are then those of a live run")
      ->group("Work");
  command
      ->add_option("--threads", a->threads,
                   "Threads to work on; but for --real-time the results do not depend on it")
      ->check(CLI::Range(1, 64))
      ->capture_default_str()
      ->group("Work");
  command
      ->add_option("--debug-images", a->debug_images,
                   "Draw the tracks of every frame set into this folder")
      ->group("Work");
  command->footer(kRunFooter);
  command->callback([a, &exit_code] {
    if (!a->map.empty() && a->method != "fused" && a->method != "semantic") {
      throw CLI::ValidationError("--map", fmt::format("{} makes nothing of a map; take --method "
                                                      "fused or semantic",
                                                      a->method));
    }
    const Status status = runSequence(*a);
    if (!status) exit_code = fail(status.error());
    constexpr int kBySignal = 128;
    if (!status && Interruption::signal() != 0) exit_code = kBySignal + Interruption::signal();
  });
}

}  // namespace parkade::cli
