// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/run_report.hpp"

#include <fmt/core.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "parkade/bev/stitcher.hpp"
#include "parkade/eval/bench_tables.hpp"
#include "parkade/eval/charts.hpp"
#include "parkade/eval/html_page.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/io/trajectory_io.hpp"
#include "parkade/mapping/map_drawing.hpp"
#include "parkade/mapping/map_file.hpp"
#include "parkade/tracking/draw_tracks.hpp"
#include "parkade/tracking/overlap.hpp"

namespace parkade::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string textOf(const std::string& path) {
  const Result<std::string> text = readFile(path);
  return text ? *text : "";
}

Json jsonOf(const std::string& path) {
  Json json = Json::parse(textOf(path), nullptr, false);
  return json.is_object() ? json : Json::object();
}

double number(const Json& json, const std::string& pointer) {
  const Json::json_pointer at(pointer);
  return json.contains(at) && json[at].is_number() ? json[at].get<double>() : std::nan("");
}

svg::Points groundPoints(const Trajectory& poses) {
  svg::Points points;
  for (const StampedPose& pose : poses) {
    points.emplace_back(pose.T_world_body.translation().head<2>());
  }
  return points;
}

// Columns of health.csv over the time from its first row.
class HealthTable {
 public:
  explicit HealthTable(const std::string& path) {
    std::stringstream lines(textOf(path));
    std::string line;
    if (std::getline(lines, line)) header_ = split(line);
    while (std::getline(lines, line)) {
      const std::vector<std::string> row = split(line);
      if (row.size() == header_.size()) rows_.push_back(row);
    }
  }

  // Only rows with a pose.
  [[nodiscard]] svg::Points over(const std::string& column) const {
    svg::Points points;
    const auto at = std::find(header_.begin(), header_.end(), column);
    if (at == header_.end()) return points;
    const std::size_t index = static_cast<std::size_t>(at - header_.begin());
    for (const auto& row : rows_) {
      if (row[1] == "initialising") continue;
      const double t = std::strtod(row[0].c_str(), nullptr);
      const double start = std::strtod(rows_.front()[0].c_str(), nullptr);
      points.emplace_back(t - start, std::strtod(row[index].c_str(), nullptr));
    }
    return points;
  }

 private:
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> parts;
    std::stringstream stream(line);
    for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
    return parts;
  }
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

TextTable summaryTable(const Json& metrics, const Json& timing) {
  TextTable table{"The run", "", {"", ""}, {}};
  const auto row = [&table](const char* name, const std::string& value) {
    table.rows.push_back({name, value});
  };
  row("source", metrics.value("source", "-"));
  row("method", metrics.value("method", "-"));
  row("recorded", figureText(number(timing, "/recorded_s"), 1) + " s");
  row("driven (estimate)", figureText(number(metrics, "/path_length_m"), 1) + " m");
  row("poses of frame sets", fmt::format("{} of {}", figureText(number(metrics, "/poses"), 0),
                                         figureText(number(metrics, "/frame_sets"), 0)));
  row("start-up", figureText(number(metrics, "/start_up_s"), 2) + " s");
  for (const char* state : {"tracking", "degraded", "lost"}) {
    row(state, figureText(number(metrics, std::string("/health/") + state), 0) + " frame sets");
  }
  row("tracks per frame set", figureText(number(metrics, "/mean_tracks"), 0));
  row("real-time factor", figureText(number(timing, "/real_time_factor"), 2));
  row("peak memory", figureText(number(timing, "/peak_memory_mb"), 0) + " MB");
  return table;
}

std::string timingChart(const Json& timing) {
  std::vector<ChartBar> bars;
  if (timing.contains("stages")) {
    for (const auto& [name, stage] : timing["stages"].items()) {
      const double mean = number(stage, "/mean_ms");
      const double p95 = number(stage, "/p95_ms");
      bars.push_back({name, mean, p95, fmt::format("{:.1f} / {:.1f}", mean, p95)});
    }
  }
  return barChart("Time of a call: mean / p95, ms", bars);
}

// The map as a picture with ids over it; its edges are those of drawMap().
struct DrawnMap {
  ParkingMap map;
  std::optional<GroundPicture> picture;
};

std::optional<DrawnMap> drawnMap(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) return std::nullopt;
  Result<ParkingMap> map = loadMap(path);
  if (!map) return std::nullopt;
  DrawnMap drawn{std::move(map).value(), {}};
  constexpr double kMetresPerPx = 0.1;
  const Result<cv::Mat> image = drawMap(drawn.map, kMetresPerPx);
  if (!image) return drawn;
  ImageEncoding png;
  png.png = true;
  const Result<std::string> bytes = encodeImage(*image, png);
  if (!bytes) return drawn;
  drawn.picture = GroundPicture{dataUri("image/png", *bytes), mapPictureCorner(drawn.map),
                                kMetresPerPx * Eigen::Vector2d(image->cols, image->rows)};
  return drawn;
}

std::vector<GroundLabel> slotLabels(const ParkingMap& map) {
  std::vector<GroundLabel> labels;
  for (const MapSlot& slot : map.slots) {
    const Eigen::Vector2d middle =
        0.25 * (slot.corners[0] + slot.corners[1] + slot.corners[2] + slot.corners[3]);
    labels.push_back({slot.number.empty() ? std::to_string(slot.id) : slot.number, middle});
  }
  return labels;
}

const char* availabilityText(double probability_free) {
  if (probability_free > 0.65) return "free";
  return probability_free < 0.35 ? "occupied" : "open";
}

TextTable slotTable(const ParkingMap& map) {
  TextTable table;
  table.title = fmt::format("The map's {} slots", map.slots.size());
  table.header = {"id", "number", "zone", "availability", "P(free)", "seen", "x m", "y m"};
  for (const MapSlot& slot : map.slots) {
    const Eigen::Vector2d entrance = 0.5 * (slot.corners[0] + slot.corners[1]);
    table.rows.push_back({std::to_string(slot.id), slot.number, slot.zone,
                          availabilityText(slot.probability_free),
                          figureText(slot.probability_free, 2), std::to_string(slot.observations),
                          figureText(entrance.x(), 2), figureText(entrance.y(), 2)});
  }
  table.note = "x, y: middle of the entrance in the map's frame.";
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
  page.svg(groundChart("Way over the ground, m", std::nullopt,
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

void addPictures(const std::string& run_folder, HtmlPage& page) {
  const std::string tracks = textOf(joinPath(run_folder, "pictures/tracks.jpg"));
  const std::string stitched = textOf(joinPath(run_folder, "pictures/stitched.jpg"));
  if (tracks.empty() && stitched.empty()) return;
  page.section("What the cameras see, half way");
  page.beginFigures();
  if (!tracks.empty()) {
    page.picture(tracks, "Tracks: from blue (new) to red (followed for long), with their ways");
  }
  if (!stitched.empty()) page.picture(stitched, "All cameras stitched on the ground; ahead is up");
  page.endFigures();
}

}  // namespace

ReportPictures::ReportPictures(std::string folder, Rig rig, TimeNs begin_ns, TimeNs end_ns)
    : folder_(joinPath(folder, "pictures")),
      rig_(std::move(rig)),
      middle_ns_(begin_ns + (end_ns - begin_ns) / 2) {}

void ReportPictures::onTracks(const TracksEvent& event) {
  if (!drawn_ && event.frames.t_ns >= middle_ns_) draw(event);
  previous_ = event.tracks;
}

void ReportPictures::draw(const TracksEvent& event) {
  drawn_ = true;
  status_ = makeFolders(folder_);
  if (!status_) return;
  ImageEncoding jpeg;
  jpeg.jpeg_quality = 80;
  const cv::Mat tracks =
      drawTracks(event.frames, event.tracks, previous_, event.report, event.prior, rig_, "");
  status_ = writeImage(joinPath(folder_, "tracks.jpg"), tracks, jpeg);
  if (!status_) return;
  BevStitcher stitcher(rig_, BevOptions{});
  const Result<std::vector<cv::Mat>> masks = readBodyMasks(rig_);
  for (std::size_t i = 0; masks && i < masks->size(); ++i) {
    if (!(*masks)[i].empty()) stitcher.setMask(static_cast<int>(i), (*masks)[i]);
  }
  status_ =
      writeImage(joinPath(folder_, "stitched.jpg"), stitcher.stitch(event.frames).image, jpeg);
}

Status writeRunReport(const std::string& run_folder, const std::string& page_path,
                      const std::optional<ReportTruth>& truth) {
  const Json metrics = jsonOf(joinPath(run_folder, "metrics.json"));
  const Json timing = jsonOf(joinPath(run_folder, "timing.json"));
  const auto trajectory = readTrajectory(joinPath(run_folder, "trajectory.tum"));
  if (!trajectory) return trajectory.error();
  HtmlPage page(fmt::format("Parkade: {}, {}", metrics.value("source", run_folder),
                            metrics.value("method", "run")));
  page.table(summaryTable(metrics, timing));
  if (truth) addErrors(*truth, page);

  const std::optional<DrawnMap> map = drawnMap(joinPath(run_folder, "map.db"));
  page.section(map ? "Map" : "Way");
  page.beginFigures();
  const std::vector<ChartLine> way{{"way", groundPoints(trajectory->poses), false}};
  if (map && map->picture) {
    page.svg(groundChart("Map and way, m", map->picture, way), "The way on the map");
    page.svg(groundChart("Slots: painted number, or id", map->picture, {}, slotLabels(map->map)),
             "Slots: green free, red occupied, yellow not known");
  } else {
    page.svg(groundChart("Way over the ground, m", std::nullopt, way), "The way");
  }
  page.endFigures();
  if (map && !map->map.slots.empty()) page.foldedTable(slotTable(map->map));
  if (map && !map->map.objects.empty()) page.foldedTable(objectTable(map->map));

  page.section("Health and time");
  page.beginFigures();
  const HealthTable health(joinPath(run_folder, "health.csv"));
  page.svg(lineChart("Standard deviation of the position, m", "time, s",
                     {{"position", health.over("sigma_position_m"), false}}),
           "How sure the estimate is of its place");
  page.svg(lineChart("Standard deviation of the heading, deg", "time, s",
                     {{"heading", health.over("sigma_yaw_deg"), false}}),
           "And of its heading");
  page.svg(lineChart("Observations per frame set", "time, s",
                     {{"tracks", health.over("tracks"), false}}),
           "Tracks that the cameras follow");
  page.svg(timingChart(timing), "Where the time goes");
  page.endFigures();
  addPictures(run_folder, page);
  return writeFileAtomic(page_path, page.str());
}

}  // namespace parkade::cli
