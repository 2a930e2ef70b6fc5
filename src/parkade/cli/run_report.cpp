// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/run_report.hpp"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "parkade/cli/report_files.hpp"
#include "parkade/cli/report_map.hpp"
#include "parkade/eval/bench_tables.hpp"
#include "parkade/eval/charts.hpp"
#include "parkade/eval/html_page.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/trajectory_io.hpp"

namespace parkade::cli {
namespace {

using Json = nlohmann::ordered_json;

TextTable summaryTable(const Json& metrics, const Json& timing) {
  TextTable table{"The run", "", {"", ""}, {}};
  const auto row = [&table](const char* name, const std::string& value) {
    table.rows.push_back({name, value});
  };
  row("source", metrics.value("source", "-"));
  row("method", metrics.value("method", "-"));
  row("recorded", figureText(reportNumber(timing, "/recorded_s"), 1) + " s");
  row("driven (estimate)", figureText(reportNumber(metrics, "/path_length_m"), 1) + " m");
  row("poses of frame sets", fmt::format("{} of {}", figureText(reportNumber(metrics, "/poses"), 0),
                                         figureText(reportNumber(metrics, "/frame_sets"), 0)));
  row("start-up", figureText(reportNumber(metrics, "/start_up_s"), 2) + " s");
  for (const char* state : {"tracking", "degraded", "lost"}) {
    row(state,
        figureText(reportNumber(metrics, std::string("/health/") + state), 0) + " frame sets");
  }
  row("tracks per frame set", figureText(reportNumber(metrics, "/mean_tracks"), 0));
  row("real-time factor", figureText(reportNumber(timing, "/real_time_factor"), 2));
  row("peak memory", figureText(reportNumber(timing, "/peak_memory_mb"), 0) + " MB");
  return table;
}

// Where the drive found the cameras, by where they were told to sit.
TextTable cameraTable(const Json& calibration) {
  constexpr double kDegrees = 180.0 / M_PI;
  TextTable table;
  table.title = "Where the cameras were found, and their clocks";
  table.header = {"camera", "moved mm: x", "y",     "z",        "sigma", "turned deg: x",
                  "y",      "z",           "sigma", "clock ms", "sigma"};
  const bool rolling = std::any_of(calibration.begin(), calibration.end(), [](const Json& camera) {
    return camera.contains("readout_time_s");
  });
  if (rolling) table.header.insert(table.header.end(), {"readout ms", "sigma"});
  for (const Json& camera : calibration) {
    std::vector<std::string> row = {camera.value("camera", "-")};
    const auto add = [&](const std::string& value, const std::string& sigma, double unit,
                         int digits) {
      double squares = 0.0;
      for (const char* axis : {"/0", "/1", "/2"}) {
        row.push_back(figureText(unit * reportNumber(camera, value + axis), digits));
        squares += std::pow(unit * reportNumber(camera, sigma + axis), 2) / 3.0;
      }
      row.push_back(figureText(std::sqrt(squares), digits));
    };
    add("/moved_m", "/position_sigma_m", 1e3, 1);
    add("/turned_rad", "/rotation_sigma_rad", kDegrees, 3);
    row.push_back(figureText(1e3 * reportNumber(camera, "/time_offset_s"), 2));
    row.push_back(figureText(1e3 * reportNumber(camera, "/time_offset_sigma_s"), 2));
    if (rolling) {
      row.push_back(figureText(1e3 * reportNumber(camera, "/readout_time_s"), 2));
      row.push_back(figureText(1e3 * reportNumber(camera, "/readout_time_sigma_s"), 2));
    }
    table.rows.push_back(std::move(row));
  }
  table.note =
      "Against the rig file, along and about the vehicle's axes; sigma: of one axis. clock: added "
      "to "
      "the stamps of its pictures it gives the inertial unit's time; readout: of a rolling "
      "shutter, first row to last. rig.yaml holds the rig as "
      "found, "
      "for --rig.";
  return table;
}

const char* availabilityText(const MapSlot& slot) {
  if (slot.isFree()) return "free";
  return slot.isOccupied() ? "occupied" : "open";
}

TextTable slotTable(const ParkingMap& map) {
  TextTable table;
  table.title = fmt::format("The map's {} slots", map.slots.size());
  table.header = {"id", "number", "zone", "availability", "P(free)", "seen", "x m", "y m"};
  for (const MapSlot& slot : map.slots) {
    const Eigen::Vector2d entrance = slot.entrance();
    table.rows.push_back({std::to_string(slot.id), slot.number, slot.zone, availabilityText(slot),
                          figureText(slot.probability_free, 2), std::to_string(slot.observations),
                          figureText(entrance.x(), 2), figureText(entrance.y(), 2)});
  }
  table.note = "x, y: middle of the entrance in the map's frame. Seen 0 times: told by its row.";
  return table;
}

TextTable objectTable(const ParkingMap& map) {
  std::map<std::string, int> counts;
  for (const MapObject& object : map.objects) {
    ++counts[std::string(kSemanticClassNames[static_cast<std::size_t>(object.semantic_class)])];
  }
  TextTable table{"The map's objects", "", {"class", "count"}, {}};
  for (const auto& [name, count] : counts) table.rows.push_back({name, std::to_string(count)});
  return table;
}

TextTable errorTable(const Evaluation& e) {
  TextTable table;
  table.title = "Errors against the truth";
  table.header = {"", "rmse", "mean", "median", "p95", "largest"};
  const auto row = [&table](const char* name, const Statistics& s) {
    table.rows.push_back({name, figureText(s.rmse), figureText(s.mean), figureText(s.median),
                          figureText(s.p95), figureText(s.max)});
  };
  row("position m", e.ape);
  row("rotation deg", e.ape_rotation_deg);
  row("heading deg", e.ape_heading_deg);
  row("relative, over 10 m: m", e.rpe);
  table.note = fmt::format(
      "Alignment {}; at the end {:.3f} m; {:.1f} m driven; {:.1f} % of the time covered.",
      e.options.align, e.final_error, e.path_length, 100.0 * e.pairs.coverage);
  return table;
}

void addErrors(const ReportTruth& truth, HtmlPage& page) {
  const Evaluation& e = truth.evaluation;
  page.section("Errors");
  page.table(errorTable(e));
  svg::Points position;
  svg::Points heading;
  const auto& poses = e.pairs.estimate;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double t = toSeconds(poses[i].t_ns - poses.front().t_ns);
    position.emplace_back(t, e.absolute.translation[i]);
    heading.emplace_back(t, e.absolute.heading_deg[i]);
  }
  page.beginFigures();
  page.svg(groundChart(truth.plan ? "Way over the plan, m" : "Way over the ground, m", truth.plan,
                       {{"estimate", groundPoints(e.estimate), false},
                        {"truth", groundPoints(truth.reference), true}}),
           "The estimate on the truth");
  page.svg(lineChart("Position error, m", "time from the first pose, s",
                     {{"position", position, false}}),
           "Position error over time");
  page.svg(
      lineChart("Heading error, deg", "time from the first pose, s", {{"heading", heading, false}}),
      "Heading error over time");
  page.endFigures();
}

}  // namespace

std::string timingChart(const std::string& run_folder) {
  const Json timing = reportJson(joinPath(run_folder, "timing.json"));
  std::vector<ChartBar> bars;
  if (timing.contains("stages")) {
    for (const auto& [name, stage] : timing["stages"].items()) {
      const double mean = reportNumber(stage, "/mean_ms");
      const double p95 = reportNumber(stage, "/p95_ms");
      bars.push_back({name, mean, p95, fmt::format("{:.1f} / {:.1f}", mean, p95)});
    }
  }
  return barChart("Time of a call: mean / p95, ms", bars);
}

Status writeRunReport(const std::string& run_folder, const std::string& page_path,
                      const std::optional<ReportTruth>& truth) {
  const Json metrics = reportJson(joinPath(run_folder, "metrics.json"));
  const Json timing = reportJson(joinPath(run_folder, "timing.json"));
  const auto trajectory = readTrajectory(joinPath(run_folder, "trajectory.tum"));
  if (!trajectory) return trajectory.error();
  HtmlPage page(fmt::format("Parkade: {}, {}", metrics.value("source", run_folder),
                            metrics.value("method", "run")));
  page.table(summaryTable(metrics, timing));
  if (truth) addErrors(*truth, page);

  const ReportedRun run = readReportedRun(run_folder);
  page.section(run.map ? "Map" : "Way");
  addMapFigures(run, page);
  if (run.map && !run.map->slots.empty()) page.foldedTable(slotTable(*run.map));
  if (run.map && !run.map->objects.empty()) page.foldedTable(objectTable(*run.map));
  page.section("The five layers");
  addLayerFigures(run, page);
  page.section("Local and global map");
  addLocalMapFigures(run, page);
  page.section("What the cameras see");
  addCameraFigures(run, page);
  if (metrics.contains("calibration")) page.table(cameraTable(metrics["calibration"]));

  page.section("Health and time");
  page.beginFigures();
  const HealthTable health(joinPath(run_folder, "health.csv"));
  page.svg(lineChart("Standard deviation of the position, m", "time, s",
                     {{"position", health.over("sigma_position_m"), false}}),
           "How sure the estimate is of its place");
  page.svg(lineChart("Standard deviation of the heading, deg", "time, s",
                     {{"heading", health.over("sigma_yaw_deg"), false}}),
           "And of its heading");
  if (reportNumber(metrics, "/mean_tracks") > 0.0) {
    page.svg(lineChart("Observations per frame set", "time, s",
                       {{"tracks", health.over("tracks"), false}}),
             "Tracks that the cameras follow");
  }
  page.svg(timingChart(run_folder), "Where the time goes");
  page.endFigures();
  return writeFileAtomic(page_path, page.str());
}

}  // namespace parkade::cli
