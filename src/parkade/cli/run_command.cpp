// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>

#include "parkade/cli/command.hpp"
#include "parkade/cli/interruption.hpp"
#include "parkade/cli/option_checks.hpp"
#include "parkade/cli/run_methods.hpp"
#include "parkade/cli/run_sequence.hpp"
#include "parkade/core/options.hpp"
#include "parkade/pipeline/mapping_run.hpp"

namespace parkade::cli {
namespace {

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
