// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/report_map.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "parkade/cli/report_files.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/io/trajectory_io.hpp"
#include "parkade/mapping/storage/map_drawing.hpp"
#include "parkade/mapping/storage/map_file.hpp"
#include "parkade/semantics/drawing/draw_labels.hpp"

namespace parkade::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMetresPerPx = 0.1;

LegendEntry entryOf(std::string_view name, const std::array<std::uint8_t, 3>& bgr) {
  return {std::string(name), fmt::format("#{:02x}{:02x}{:02x}", bgr[2], bgr[1], bgr[0])};
}

std::vector<LegendEntry> entriesOf(const std::vector<MapColour>& colours) {
  std::vector<LegendEntry> entries;
  for (const MapColour& colour : colours) entries.push_back(entryOf(colour.name, colour.bgr));
  return entries;
}

std::optional<GroundPicture> mapPicture(const ParkingMap& map) {
  const Result<cv::Mat> image = drawMap(map, kMetresPerPx);
  const std::string bytes = reportPng(image);
  if (bytes.empty()) return std::nullopt;
  return GroundPicture{dataUri("image/png", bytes), mapPictureCorner(map),
                       kMetresPerPx * Eigen::Vector2d(image->cols, image->rows), false};
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

// Where a picture of the local map lies, as pictures.json says.
struct LocalPlace {
  TimeNs t_ns = 0;
  Eigen::Vector2d top_left = Eigen::Vector2d::Zero();
  double size = 0.0;
  SE2 T_odom_car;
  svg::Points car;  // its outline with a nose, in its own frame
};

std::optional<LocalPlace> localPlace(const Json& json) {
  const auto numbers = [&json](const char* name, std::size_t count) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
      values.push_back(reportNumber(json, fmt::format("/{}/{}", name, i)));
    }
    return values;
  };
  if (!json.is_object() || !json.contains("t_ns")) return std::nullopt;
  const std::vector<double> corner = numbers("top_left", 2);
  const std::vector<double> car = numbers("car", 3);
  std::vector<double> shape = numbers("car_shape", 3);
  LocalPlace place;
  place.t_ns = json.value("t_ns", TimeNs{0});
  place.top_left = {corner[0], corner[1]};
  place.size = reportNumber(json, "/size_m");
  place.T_odom_car = SE2(car[2], {car[0], car[1]});
  if (!(place.size > 0.0) || !place.top_left.allFinite() ||
      !std::isfinite(car[0] + car[1] + car[2]))
    return std::nullopt;
  if (!std::isfinite(shape[0] + shape[1] + shape[2])) shape = {-0.5, 0.5, 0.5};  // only a sign
  const double half = 0.5 * shape[2];
  place.car = {{shape[0], half},         {shape[1] - half, half}, {shape[1], 0.0},
               {shape[1] - half, -half}, {shape[0], -half},       {shape[0], half}};
  return place;
}

svg::Points moved(const SE2& T, const svg::Points& points) {
  svg::Points result;
  for (const Eigen::Vector2d& p : points) result.emplace_back(T * p);
  return result;
}

// From the odometry's frame to the map's, as known at the instant; nothing without a pose there.
std::optional<SE2> worldFromOdom(const Trajectory& way, const LocalPlace& place) {
  for (const StampedPose& pose : way) {
    if (std::abs(pose.t_ns - place.t_ns) < kNsPerMs) {
      return SE2::fromSE3(pose.T_world_body) * place.T_odom_car.inverse();
    }
  }
  return std::nullopt;
}

GroundPicture localPicture(const LocalPlace& place, const std::string& bytes) {
  return {dataUri("image/png", bytes), place.top_left, Eigen::Vector2d::Constant(place.size), true};
}

double secondsInto(const ReportedRun& run, TimeNs t_ns) {
  return run.way.empty() ? 0.0 : toSeconds(t_ns - run.way.front().t_ns);
}

std::string withoutMap(const ReportedRun& run, const char* what) {
  return fmt::format("{}: none, as {}.", what,
                     run.method == "vis" ? "the method vis makes no map"
                                         : "the run wrote no map that can be drawn");
}

void addMovingLayer(const ReportedRun& run, HtmlPage& page) {
  const Json json = reportJson(joinPath(run.folder, "pictures/pictures.json"));
  const std::string bytes = reportText(joinPath(run.folder, "pictures/local_moving.png"));
  const std::optional<LocalPlace> place =
      json.contains("local_moving") ? localPlace(json["local_moving"]) : std::nullopt;
  if (bytes.empty() || !place) return;
  page.svg(groundChart("Dynamic objects around the car, m", localPicture(*place, bytes),
                       {{"car", moved(place->T_odom_car, place->car), false}}),
           fmt::format("Layer 5 around the car, {:.1f} s after the first pose, when most moved: {}",
                       secondsInto(run, place->t_ns), json["local_moving"].value("moving", 0)),
           entriesOf(layerLegend(GridLayer::kDynamic)));
}

}  // namespace

ReportedRun readReportedRun(const std::string& folder) {
  ReportedRun run;
  run.folder = folder;
  run.method = reportJson(joinPath(folder, "metrics.json")).value("method", "");
  Result<TrajectoryFile> way = readTrajectory(joinPath(folder, "trajectory.tum"));
  if (way) run.way = std::move(way->poses);
  const std::string map_path = joinPath(folder, "map.db");
  if (std::filesystem::is_regular_file(map_path)) {
    Result<ParkingMap> map = loadMap(map_path);
    if (map) run.map = std::move(map).value();
  }
  return run;
}

void addMapFigures(const ReportedRun& run, HtmlPage& page) {
  const std::vector<ChartLine> way{{"way", groundPoints(run.way), false}};
  const std::optional<GroundPicture> picture =
      run.map ? mapPicture(*run.map) : std::optional<GroundPicture>();
  page.beginFigures();
  if (!picture) {
    page.svg(groundChart("Way over the ground, m", std::nullopt, way), "The way");
    page.endFigures();
    return;
  }
  page.svg(groundChart("Map and way, m", picture, way), "The way on the map",
           entriesOf(mapLegend()));
  if (run.map->slots.empty()) {
    page.endFigures();
    page.paragraph(
        fmt::format("Slots: none; the method {} does not look for them, or saw none.", run.method));
    return;
  }
  page.svg(groundChart("Slots: painted number, or id", picture, {}, slotLabels(*run.map)),
           "The map's slots and whether they are free", entriesOf(slotLegend()));
  page.endFigures();
}

void addLayerFigures(const ReportedRun& run, HtmlPage& page) {
  constexpr std::array<const char*, kNumGridLayers> kCaptions = {
      "Layer 1: parking lines", "Layer 2: availability of slots", "Layer 3: road markers",
      "Layer 4: zone markers, with pillars and walls", "Layer 5: dynamic objects at the end"};
  if (!run.map) return page.paragraph(withoutMap(run, "Layers"));
  std::vector<std::string> without;
  page.beginFigures(true);
  for (std::size_t i = 0; i < kNumGridLayers; ++i) {
    const GridLayer layer = kGridLayers[i];
    const bool slots = layer == GridLayer::kAvailability && !run.map->slots.empty();
    const std::string bytes = slots || run.map->grid.bounds(layer)
                                  ? reportPng(drawLayer(*run.map, layer, kMetresPerPx))
                                  : "";
    if (bytes.empty()) {
      without.emplace_back(kCaptions[i]);
    } else {
      page.picture(bytes, kCaptions[i], entriesOf(layerLegend(layer)));
    }
  }
  page.endFigures();
  for (const std::string& caption : without) {
    page.paragraph(fmt::format("{}: the map of {} holds none.", caption, run.method));
  }
}

void addLocalMapFigures(const ReportedRun& run, HtmlPage& page) {
  const Json json = reportJson(joinPath(run.folder, "pictures/pictures.json"));
  const std::string bytes = reportText(joinPath(run.folder, "pictures/local_map.png"));
  const std::optional<LocalPlace> place =
      json.contains("local_map") ? localPlace(json["local_map"]) : std::nullopt;
  const std::optional<GroundPicture> global =
      run.map ? mapPicture(*run.map) : std::optional<GroundPicture>();
  if (bytes.empty() || !place || !global) {
    page.paragraph(run.map
                       ? fmt::format("Local map: none, as the method {} keeps none.", run.method)
                       : withoutMap(run, "Local and global map"));
    return;
  }
  page.beginFigures();
  page.svg(groundChart("Local map, m", localPicture(*place, bytes),
                       {{"car", moved(place->T_odom_car, place->car), false}}),
           fmt::format("The local map {:.1f} s after the first pose, as a planner has it then: all "
                       "layers, in the odometry's frame",
                       secondsInto(run, place->t_ns)),
           entriesOf(mapLegend()));
  std::vector<ChartLine> lines{{"way", groundPoints(run.way), false}};
  if (const std::optional<SE2> T_world_odom = worldFromOdom(run.way, *place)) {
    const Eigen::Vector2d a = place->top_left;
    const double s = place->size;
    const svg::Points square{a, {a.x() + s, a.y()}, {a.x() + s, a.y() - s}, {a.x(), a.y() - s}, a};
    lines.push_back({"local map", moved(*T_world_odom, square), false});
    lines.push_back({"car", moved(*T_world_odom * place->T_odom_car, place->car), false});
  }
  GroundPicture whole = *global;
  whole.whole = true;
  page.svg(groundChart("Global map, m", whole, lines),
           "The global map at the end of the drive, and where the local one lay");
  addMovingLayer(run, page);
  page.endFigures();
}

void addCameraFigures(const ReportedRun& run, HtmlPage& page) {
  const auto bytesOf = [&run](const char* name) {
    return reportText(joinPath(joinPath(run.folder, "pictures"), name));
  };
  const std::string tracks = bytesOf("tracks.jpg");
  const std::string stitched = bytesOf("stitched.jpg");
  const std::string features = bytesOf("features.jpg");
  if (!tracks.empty()) {
    page.picture(tracks,
                 "Tracks of key points on the cameras' pictures, half way: from blue (new) to red "
                 "(followed for long), with their ways");
  } else {
    page.paragraph("Tracks: none, as the method " + run.method + " follows no key points.");
  }
  page.beginFigures();
  if (!stitched.empty()) {
    page.picture(stitched, "All cameras stitched on the ground, half way; ahead is up");
  }
  if (!features.empty()) {
    const Json json = reportJson(joinPath(run.folder, "pictures/pictures.json"));
    std::vector<LegendEntry> legend;
    for (std::size_t i = 0; i < kNumSemanticClasses; ++i) {
      const Json names = json.value("/features/classes"_json_pointer, Json::array());
      if (std::find(names.begin(), names.end(), kSemanticClassNames[i]) == names.end()) continue;
      std::string name(kSemanticClassNames[i]);
      std::replace(name.begin(), name.end(), '_', ' ');
      legend.push_back(entryOf(name, colourOf(static_cast<SemanticClass>(i))));
    }
    page.picture(features,
                 "The same picture with what is found on it: classes in colour, lines white; slots "
                 "green where free, red where occupied, yellow where not known, their entrances "
                 "thick; boxes of vehicles and people",
                 legend);
  }
  page.endFigures();
  if (features.empty()) {
    page.paragraph(run.method == "vis" ? "Features: none, as the method vis uses no semantics."
                                       : "Features: none, as the run wrote no picture of them.");
  }
}

}  // namespace parkade::cli
