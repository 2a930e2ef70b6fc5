// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "parkade/cli/command.hpp"
#include "parkade/cli/sim_pictures.hpp"
#include "parkade/cli/sim_record.hpp"
#include "parkade/sim/drive/rig_presets.hpp"
#include "parkade/sim/drive/routes.hpp"
#include "parkade/sim/drive/simulation.hpp"

namespace parkade::cli {
namespace {

constexpr const char* kSimFooter = R"(
Examples:
  parkade sim --garage paper --route test1 --out test1
  parkade sim --route test5 --out quick --fast --duration 20
  parkade sim --garage random --garage-seed 12 --route random --lux 40 --out other
  parkade sim --route test3 --preview plan.png
  parkade sim --list

Light, occupancy, cars, people and speed belong to the route unless set (--list shows them). The same
options and seeds give the same bytes. Details: docs/simulator.md)";

struct Arguments {
  std::string garage = "paper";
  std::string route;
  std::vector<std::pair<std::string, std::string>> values;  // fields of SimSpec
  bool list = false;
  std::string preview;
  std::string pictures;
  RecordOptions record;
};

// An option whose text becomes a field of the spec, which checks it.
void addField(CLI::App& command, Arguments& arguments, const std::string& option,
              const std::string& field, const std::string& type, const std::string& help) {
  command
      .add_option_function<std::string>(
          option,
          [&arguments, field](const std::string& text) {
            arguments.values.emplace_back(field, text);
          },
          help)
      ->type_name(type);
}

void addPair(CLI::App& command, Arguments& arguments, const std::string& option,
             const std::string& first, const std::string& second, const std::string& type,
             const std::string& help) {
  command
      .add_option_function<std::string>(
          option,
          [&arguments, option, first, second](const std::string& text) {
            const std::size_t comma = text.find(',');
            if (comma == std::string::npos) {
              throw CLI::ValidationError(option,
                                         "expected two values with a comma between them, "
                                         "found '" +
                                             text + "'");
            }
            arguments.values.emplace_back(first, text.substr(0, comma));
            arguments.values.emplace_back(second, text.substr(comma + 1));
          },
          help)
      ->type_name(type);
}

void addSpecOptions(CLI::App& command, Arguments& arguments) {
  command.add_option("--garage", arguments.garage, "Garage: paper or random")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option("--route", arguments.route,
                  "Route: test1 to test5 (paper) or random (default: test1, or random)")
      ->type_name("NAME");
  addField(command, arguments, "--seed", "seed", "N",
           "Seed of what happens on the drive: stops, people, noise [1]");
  addField(command, arguments, "--garage-seed", "garage_seed", "N",
           "Seed of the garage: layout, parked cars, wear [1]");
  addField(command, arguments, "--parked-seed", "parked_seed", "N",
           "Seed of which slots hold which cars [the garage's]");
  addField(command, arguments, "--lux", "lux", "LX", "Mean light on the floor, 1 to 5000");
  addField(command, arguments, "--occupancy", "occupancy", "SHARE",
           "Share of slots with a parked car, 0 to 1");
  addField(command, arguments, "--one-way", "one_way", "SHARE",
           "Share of a random garage's aisles that are one-way, 0 to 1 [0]");
  addField(command, arguments, "--first-zone", "first_zone", "LETTER",
           "Letter of the first row's zones [A]");
  addPair(command, arguments, "--agents", "cars", "people", "CARS,PEOPLE",
          "Moving cars and walking people");
  addField(command, arguments, "--speed-kmh", "speed_kmh", "KMH", "Highest speed of the own car");
  addField(command, arguments, "--rig", "rig", "NAME|FILE",
           "Sensors: avp6, nuscenes6, avm4 or a rig.yaml [avp6]");
  command.add_flag_callback(
      "--fast", [&arguments] { arguments.values.emplace_back("fast", "on"); },
      "One sample per pixel, 2 x 2 only where a surface ends");
  addField(command, arguments, "--motion-blur", "motion_blur", "N",
           "Sub-frames within an exposure [1: none]");
  addField(command, arguments, "--readout-ms", "readout_ms", "MS",
           "Rolling shutter: time from the first row to the last [the rig's]");
  addField(command, arguments, "--noise", "noise", "on|off", "Errors of all sensors [on]");
  addField(command, arguments, "--load", "load", "on|off",
           "Static tilt by passengers and luggage [on]");
  command.add_flag_callback(
      "--rolling-start", [&arguments] { arguments.values.emplace_back("rolling_start", "on"); },
      "Begin while the car is moving");
  addField(command, arguments, "--duration", "duration", "S",
           "Cut the drive short after S seconds [0: all]");
  addPair(command, arguments, "--calib-error", "calib_error_deg", "calib_error_cm", "DEG,CM",
          "Tell the reader a rig that is wrong by this much (standard deviations)");
  addField(command, arguments, "--threads", "threads", "N",
           "Threads that draw [all processors]; the bytes do not depend on it");
}

void addOutputOptions(CLI::App& command, Arguments& arguments) {
  RecordOptions& record = arguments.record;
  command.add_option("--out", record.out, "Folder to write the sequence to")->type_name("SEQ");
  command.add_flag("--labels", record.labels, "Write a label image for every picture");
  command.add_flag("--bev-labels", record.bev_labels,
                   "Write the labels of the ground around the car for every frame set");
  command.add_flag("--gray-png", record.gray_png, "Write gray PNG instead of colour JPEG");
  command.add_flag_callback(
      "--no-images", [&arguments] { arguments.values.emplace_back("images", "off"); },
      "Inertial unit, wheels and truth only");
  command.add_flag("--resume", record.resume, "Go on with an interrupted recording in --out");
  command.add_flag("--force", record.force, "Replace a recording in --out");
  command.add_flag("--list", arguments.list, "Show garages, routes and rigs, and exit");
  command.add_option("--preview", arguments.preview, "Write a plan of the route, and exit")
      ->type_name("PNG");
  command
      .add_option("--pictures", arguments.pictures,
                  "Write pictures of every camera, from above and of the whole garage, and exit")
      ->type_name("DIR");
}

int list() {
  fmt::print("{:<8} {:<8} {:>7} {:>6} {:>6} {:>9} {:>5} {:>7} {:>6}  {}\n", "garage", "route",
             "length", "time", "lux", "occupied", "cars", "people", "km/h", "shape");
  for (const sim::RouteInfo& info : sim::routeCatalogue()) {
    std::string length = "varies";
    std::string time = "varies";
    if (!info.garage.empty()) {
      const Result<sim::SimSpec> spec = sim::defaultSpec(info.garage, info.name);
      if (!spec) return fail(spec.error());
      const auto simulation = sim::Simulation::make(*spec);
      if (!simulation) return fail(simulation.error());
      length = fmt::format("{:.0f} m", (*simulation)->route().path.length());
      time = fmt::format("{:.0f} s", (*simulation)->duration());
    }
    fmt::print("{:<8} {:<8} {:>7} {:>6} {:>6} {:>8.0f}% {:>5} {:>7} {:>6.1f}  {}\n",
               info.garage.empty() ? "any" : info.garage, info.name, length, time, info.lux,
               100.0 * info.occupancy, info.cars, info.people, 3.6 * info.max_speed, info.shape);
  }
  fmt::print("\ngarages: paper, random (another one for every --garage-seed)\nrigs:    {}\n",
             fmt::join(sim::rigPresetNames(), ", "));
  return 0;
}

int run(Arguments& arguments) {
  if (arguments.list) return list();
  std::string route = arguments.route;
  if (route.empty()) route = arguments.garage == "random" ? "random" : "test1";
  // The user's own number of threads comes later in the list, and wins.
  arguments.values.insert(arguments.values.begin(), {"threads", std::to_string(defaultThreads())});
  const Result<sim::SimSpec> spec = sim::makeSpec(arguments.garage, route, arguments.values, "sim");
  if (!spec) return failUsage(spec.error());
  const bool draws = !arguments.preview.empty() || !arguments.pictures.empty();
  if (arguments.record.out.empty() && !draws) {
    return failUsage({"sim: --out SEQ is missing: where shall the recording go?"});
  }
  const auto simulation = sim::Simulation::make(*spec);
  if (!simulation) return failUsage(simulation.error());
  Status status;
  if (!arguments.preview.empty()) status = writePlan(**simulation, arguments.preview);
  if (status && !arguments.pictures.empty()) {
    status = writePictures(*simulation, arguments.pictures);
  }
  if (status && !draws) status = recordSequence(*simulation, arguments.record);
  return status ? 0 : fail(status.error());
}

}  // namespace

void addSimCommand(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "sim", "Drive a car through a simulated garage and record all its sensors, with every truth");
  const auto arguments = std::make_shared<Arguments>();
  addSpecOptions(*command, *arguments);
  addOutputOptions(*command, *arguments);
  command->footer(kSimFooter);
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace parkade::cli
