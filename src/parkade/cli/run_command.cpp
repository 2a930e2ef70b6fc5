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
#include "parkade/cli/map_path.hpp"
#include "parkade/cli/open_source.hpp"
#include "parkade/cli/run_outputs.hpp"
#ifdef PARKADE_WITH_REPORT
#include "parkade/cli/report_pictures.hpp"
#include "parkade/cli/run_report.hpp"
#endif
#include "parkade/core/options.hpp"
#include "parkade/core/progress.hpp"
#include "parkade/io/file.hpp"
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
    "SEQ is a sequence folder (docs/formats.md). OUT then holds trajectory.tum (one pose per "
    "frame\n"
    "set from the start on, as known at its instant), trajectory_vio.tum, health.csv, "
    "timing.json,\n"
    "metrics.json, config.yaml and report.html; with --final also trajectory_final.tum. With "
    "--map\n"
    "all poses are in the map's frame, and trajectory.tum begins where the car is found in it.\n"
    "\n"
    "'parkade run --help-options' lists every option that --set and --config take.\n"
    "\n"
    "Examples:\n"
    "  parkade run SEQ --out OUT\n"
    "  parkade run SEQ --out OUT --cameras cam0 --set vio.window.keyframes=8 --final\n"
    "  parkade run SEQ --out OUT --method fused\n"
    "  parkade run LATER --out OUT2 --method fused --map OUT\n"
    "  parkade run SEQ --out OUT --duration 5 --debug-images OUT/tracks";

Status configure(const RunArguments& arguments, PipelineOptions& options) {
  if (!arguments.config.empty()) {
    Status status = loadOptions(asOptions(options), arguments.config);
    if (!status) return status;
  }
  for (const std::string& assignment : arguments.assignments) {
    Status status = setOption(asOptions(options), assignment);
    if (!status) return status;
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

Status runSequence(const RunArguments& arguments) {
  PipelineOptions options;
  if (Status status = configure(arguments, options); !status) return status;
  if (arguments.real_time) {
    options.pace = 1.0;
    options.live = true;
  }
  const RunMethod method = methodOf(arguments.method);
  SourceRequest request = arguments.source;
  // The paper's semantic method has one camera: the front one, where the user names no other.
  if (method == RunMethod::kSemantic && request.cameras.empty()) request.cameras = "cam0";
  request.decode_threads = arguments.threads > 1 ? 1 : 0;
  request.gray = method == RunMethod::kVis;  // networks want colour
  request.gray_beside = method == RunMethod::kFused;
  Result<OpenedSource> opened = openSource(request);
  if (!opened) return opened.error();
  auto run = MappingRun::create(opened->rig, options, arguments.threads, method);
  if (!run) return run.error();
  if (!arguments.map.empty()) {
    if (Status located = locateInMap(arguments.map, **run); !located) return located;
  }
  // Last, for it removes what an earlier run left there.
  if (Status status = prepareRunFolder(arguments.out, arguments.force); !status) return status;

  HealthLog health;
  (*run)->addObserver(&health);
  std::optional<DebugImages> images;
  if (!arguments.debug_images.empty()) {
    images.emplace(arguments.debug_images, opened->rig);
    (*run)->addObserver(&*images);
  }
#ifdef PARKADE_WITH_REPORT
  const SensorSourceInfo& info = opened->source->info();
  ReportPictures pictures(arguments.out, opened->rig, info.start_ns, info.end_ns,
                          method != RunMethod::kVis);
  (*run)->addObserver(&pictures);
#endif
  ProgressPrinter progress("run");
  const Status outcome = (*run)->run(*opened->source, progress.callback());
  progress.finish();

  RunDescription description;
  description.source = arguments.source.spec;
  description.cameras = request.cameras;
  for (const RigCamera& camera : opened->rig.cameras) {
    description.camera_names.push_back(camera.name);
  }
  description.method = arguments.method;
  description.config = dumpOptions(asOptions(options));
  description.threads = arguments.threads;
  Status written = writeRunFiles(arguments.out, description, **run, health, arguments.with_final);
  if (!written) return written;
  if (Status saved = writeMap(arguments.out, arguments.source.spec, **run); !saved) return saved;
  const RunSummary& summary = (*run)->summary();
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
  if (!outcome) {
    return Error{fmt::format("{} (the poses up to there are in {})", outcome.error().message,
                             arguments.out)};
  }
  if (images && !images->status()) return images->status();
  if (summary.poses == 0 && !arguments.map.empty() && !(*run)->odometry().empty()) {
    return Error{fmt::format(
        "{}: the car was not found in {}; is it a map of this garage, and of a place that the "
        "drive came by? The odometry's poses are in {}",
        arguments.source.spec, arguments.map, joinPath(arguments.out, "trajectory_vio.tum"))};
  }
  if (summary.poses == 0) {
    return Error{fmt::format("{}: no pose: the estimator did not start; see the reasons in {}",
                             arguments.source.spec, joinPath(arguments.out, "health.csv"))};
  }
  return {};
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
      ->check(CLI::IsMember({"fused", "semantic", "vis", "avp-slam"}))
      ->capture_default_str();
  command->add_option(
      "--map", a->map,
      "Find the car in this saved map (map.db, or the run's folder) and localise in "
      "it: all poses are the map's");
  command->add_flag("--final", a->with_final,
                    "Also write trajectory_final.tum: every pose with all that came after it");
  command->add_flag("--force", a->force, "Write into a folder that holds something else");

  command->add_option("--cameras", a->source.cameras, "Cameras to use, as cam0,cam1; default: all")
      ->group("Input");
  command->add_option("--start", a->source.start_s, "Skip this much of the sequence, s")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group("Input");
  command->add_option("--duration", a->source.duration_s, "Stop after this much, s; 0: at the end")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
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
                 "pictures over where the computer does not keep up: latencies are then those of "
                 "a live run")
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
  });
}

}  // namespace parkade::cli
