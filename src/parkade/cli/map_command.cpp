// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/map_command.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "parkade/cli/command.hpp"
#include "parkade/cli/map_path.hpp"
#include "parkade/core/json_text.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/map_merge.hpp"
#include "parkade/mapping/storage/map_drawing.hpp"
#include "parkade/mapping/storage/map_export.hpp"
#include "parkade/mapping/storage/map_file.hpp"

namespace parkade::cli {
namespace {

struct MapArguments {
  std::string path;
  std::string later;
  std::string json;
  std::string out;
  std::vector<std::string> formats;
  double metres_per_px = 0.05;

  [[nodiscard]] bool wants(const char* format) const {
    return formats.empty() || std::find(formats.begin(), formats.end(), format) != formats.end();
  }
};

constexpr double kMostMetresPerPx = 10.0;

nlohmann::json layerJson(const ParkingMap& map, GridLayer layer) {
  std::int64_t known = 0;
  std::int64_t present = 0;
  for (const auto& [at, tile] : map.grid.tiles(layer)) {
    for (const GridCell& cell : tile.cells) {
      known += cell.known() ? 1 : 0;
      present += cell.known() && cell.log_odds > 0 && cell.semantic_class != SemanticClass::kFloor;
    }
  }
  const double area = map.grid.resolution() * map.grid.resolution();
  return {{"known_m2", area * static_cast<double>(known)},
          {"present_m2", area * static_cast<double>(present)}};
}

double graphLength(const ParkingMap& map) {
  double length = 0.0;
  for (std::size_t i = 1; i < map.nodes.size(); ++i) {
    length += (map.nodes[i].T_world_vehicle.translation() -
               map.nodes[i - 1].T_world_vehicle.translation())
                  .norm();
  }
  return length;
}

nlohmann::json describe(const std::string& path, const ParkingMap& map) {
  std::error_code code;
  nlohmann::json result = {{"name", map.name},
                           {"file_bytes", std::filesystem::file_size(path, code)},
                           {"schema_version", kMapSchemaVersion},
                           {"resolution_m", map.grid.resolution()}};
  if (const auto bounds = map.grid.bounds()) {
    const Eigen::Vector2d low = map.grid.resolution() * bounds->min.cast<double>();
    const Eigen::Vector2d high =
        map.grid.resolution() * (bounds->max + Eigen::Vector2i::Ones()).cast<double>();
    result["min"] = {low.x(), low.y()};
    result["max"] = {high.x(), high.y()};
  }
  for (const GridLayer layer : kGridLayers) {
    result["layers"][std::string(kGridLayerNames[static_cast<std::size_t>(layer)])] =
        layerJson(map, layer);
  }
  int free = 0;
  int occupied = 0;
  int numbered = 0;
  for (const MapSlot& slot : map.slots) {
    free += slot.isFree() ? 1 : 0;
    occupied += slot.isOccupied() ? 1 : 0;
    numbered += slot.number.empty() ? 0 : 1;
  }
  result["slots"] = {
      {"count", map.slots.size()}, {"free", free}, {"occupied", occupied}, {"numbered", numbered}};
  result["objects"] = nlohmann::json::object();
  for (const MapObject& object : map.objects) {
    const std::string name(kSemanticClassNames[static_cast<std::size_t>(object.semantic_class)]);
    result["objects"][name] = result["objects"].value(name, 0) + 1;
  }
  const auto loops = std::count_if(map.edges.begin(), map.edges.end(), [](const PoseGraphEdge& e) {
    return e.kind == EdgeKind::kLoop;
  });
  result["graph"] = {{"nodes", map.nodes.size()},
                     {"edges", map.edges.size()},
                     {"loops", loops},
                     {"length_m", graphLength(map)}};
  return result;
}

std::string textOf(const std::string& path, const nlohmann::json& d) {
  std::string text =
      fmt::format("{}: map '{}', {:.2f} MB, cells of {} m\n", path, d["name"].get<std::string>(),
                  1e-6 * d["file_bytes"].get<double>(), d["resolution_m"].get<double>());
  if (d.contains("min")) {
    text += fmt::format("  extent   x {:.2f} to {:.2f} m, y {:.2f} to {:.2f} m\n",
                        d["min"][0].get<double>(), d["max"][0].get<double>(),
                        d["min"][1].get<double>(), d["max"][1].get<double>());
  } else {
    text += "  extent   no cell is known\n";
  }
  for (const std::string_view name : kGridLayerNames) {
    const nlohmann::json& layer = d["layers"][std::string(name)];
    text += fmt::format("  layer    {:<14}{:>10.1f} m^2 seen,{:>9.1f} m^2 present\n", name,
                        layer["known_m2"].get<double>(), layer["present_m2"].get<double>());
  }
  const nlohmann::json& slots = d["slots"];
  text += fmt::format("  slots    {} ({} free, {} occupied, {} with a number)\n",
                      slots["count"].get<int>(), slots["free"].get<int>(),
                      slots["occupied"].get<int>(), slots["numbered"].get<int>());
  std::string objects;
  for (const auto& [name, count] : d["objects"].items()) {
    objects += fmt::format("{}{} {}", objects.empty() ? "" : ", ", count.get<int>(), name);
  }
  const nlohmann::json& graph = d["graph"];
  text += fmt::format("  objects  {}\n", objects.empty() ? "none" : objects);
  text += fmt::format("  graph    {} nodes over {:.1f} m, {} edges, {} of them loops\n",
                      graph["nodes"].get<int>(), graph["length_m"].get<double>(),
                      graph["edges"].get<int>(), graph["loops"].get<int>());
  return text;
}

Status showMap(const MapArguments& arguments) {
  return describeMap(arguments.path, arguments.json);
}

Status checkMap(const MapArguments& arguments) {
  const Result<ParkingMap> map = loadMap(arguments.path);
  if (!map) return map.error();
  if (Status status = checkIntegrity(arguments.path); !status) return status;
  const std::vector<std::string> faults = findFaults(*map);
  if (!arguments.json.empty()) {
    const nlohmann::json result = {{"faults", faults}};
    const std::string text = jsonText(result);
    if (Status status = writeFileAtomic(arguments.json, text); !status) return status;
  }
  if (faults.empty()) {
    fmt::print("{}: sound: {} slots, {} objects, {} nodes\n", arguments.path, map->slots.size(),
               map->objects.size(), map->nodes.size());
    return {};
  }
  for (const std::string& fault : faults) fmt::print("{}: {}\n", arguments.path, fault);
  return Error{
      fmt::format("{}: {} fault{}", arguments.path, faults.size(), faults.size() == 1 ? "" : "s")};
}

Status exportPicture(const MapArguments& arguments, const ParkingMap& map) {
  const Result<cv::Mat> picture = drawMap(map, arguments.metres_per_px);
  if (!picture) return picture.error();
  ImageEncoding encoding;
  encoding.png = true;
  return writeImage(joinPath(arguments.out, "map.png"), *picture, encoding);
}

// Finds what would fail before anything is written.
Status checkExport(const MapArguments& arguments, const ParkingMap& map) {
  const auto refused = [&](const char* format, const Status& fits, const std::string& remedy) {
    return Error{fmt::format(
        "{}: {}: {}; {}choose formats other than {} (--format), or see with 'parkade map check {}' "
        "what lies too far away; nothing was written",
        arguments.path, format, fits.error().message, remedy, format, arguments.path)};
  };
  if (arguments.wants("nav2")) {
    const Status fits = checkPictureSize(nav2PictureSize(map));
    if (!fits) return refused("nav2", fits, "");
  }
  if (arguments.wants("png")) {
    const Status fits = checkPictureSize(mapPictureSize(map, arguments.metres_per_px));
    const double finest = finestMetresPerPx(map);
    const std::string coarser = fmt::format("take --metres-per-px {:.2f} or more, ", finest);
    if (!fits) return refused("png", fits, finest <= kMostMetresPerPx ? coarser : "");
  }
  return {};
}

Status exportMap(const MapArguments& arguments) {
  const Result<ParkingMap> map = loadMap(arguments.path);
  if (!map) return map.error();
  if (Status fits = checkExport(arguments, *map); !fits) return fits;
  if (Status made = makeFolders(arguments.out); !made) return made;
  if (arguments.wants("nav2")) {
    for (const GridLayer layer : kGridLayers) {
      if (Status status = exportNav2(*map, layer, arguments.out); !status) return status;
    }
  }
  if (arguments.wants("png")) {
    if (Status status = exportPicture(arguments, *map); !status) return status;
  }
  if (arguments.wants("geojson")) {
    Status status = exportGeoJson(*map, joinPath(arguments.out, "map.geojson"));
    if (!status) return status;
  }
  if (arguments.wants("lanelet2")) {
    Status status = exportLanelet2(*map, joinPath(arguments.out, "map.osm"));
    if (!status) return status;
  }
  fmt::print("{}: exported to {}\n", arguments.path, arguments.out);
  return {};
}

Status mergeMaps(const MapArguments& arguments) {
  Result<ParkingMap> saved = loadMap(arguments.path);
  if (!saved) return saved.error();
  const Result<ParkingMap> later = loadMap(arguments.later);
  if (!later) return later.error();
  const Result<MergeReport> report = mergeMap(*later, *saved);
  if (!report) {
    return Error{
        fmt::format("{} into {}: {}", arguments.later, arguments.path, report.error().message)};
  }
  const std::string out = mapFileOf(arguments.out);
  if (Status written = saveMap(*saved, out); !written) return written;
  const std::string gone =
      report->objects_gone > 0
          ? fmt::format(", {} gone, for bare floor was seen there", report->objects_gone)
          : "";
  fmt::print(
      "{}: {} slots ({} seen again, {} new, {} refused, for they lie across others), {} objects "
      "({} seen again, {} new{})\n",
      out, saved->slots.size(), report->slots_again, report->slots_new, report->slots_refused,
      saved->objects.size(), report->objects_again, report->objects_new, gone);
  return {};
}

CLI::App* addAction(CLI::App* command, const char* name, const char* help, const char* example,
                    const std::shared_ptr<MapArguments>& a, int& exit_code,
                    Status (*action)(const MapArguments&)) {
  auto* sub = command->add_subcommand(name, help);
  sub->add_option("MAP", a->path, "Map file, such as a run's map.db, or the run's folder")
      ->required();
  sub->footer(std::string("Example:\n  ") + example);
  sub->callback([a, action, &exit_code] {
    for (std::string* path : {&a->path, &a->later}) *path = mapFileOf(*path);
    const Status status = action(*a);
    if (!status) exit_code = fail(status.error());
  });
  return sub;
}

}  // namespace

Status describeMap(const std::string& path, const std::string& json) {
  const Result<ParkingMap> map = loadMap(path);
  if (!map) return map.error();
  const nlohmann::json description = describe(path, *map);
  fmt::print("{}", textOf(path, description));
  if (json.empty()) return {};
  return writeFileAtomic(json, jsonText(description));
}

void addMapCommand(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("map", "Describe, check, export or merge maps");
  const auto a = std::make_shared<MapArguments>();
  command->require_subcommand(1);
  auto* info = addAction(command, "info", "Say what a map holds",
                         "parkade map info OUT/map.db --json map.json", a, exit_code, showMap);
  info->add_option("--json", a->json, "Write the same as JSON to this file");
  auto* check = addAction(command, "check",
                          "Look for damage and contradictions; exit code 1 where "
                          "there are any",
                          "parkade map check OUT/map.db", a, exit_code, checkMap);
  check->add_option("--json", a->json, "Write the faults as JSON to this file");
  auto* out = addAction(command, "export", "Write the formats of others",
                        "parkade map export OUT/map.db --out OUT/map --format nav2,geojson", a,
                        exit_code, exportMap);
  out->add_option("-o,--out", a->out, "Folder to write, made where it is not there")->required();
  out->add_option("--format", a->formats, "nav2, png, geojson, lanelet2; default: all")
      ->delimiter(',')
      ->check(CLI::IsMember({"nav2", "png", "geojson", "lanelet2"}));
  out->add_option("--metres-per-px", a->metres_per_px, "Of the picture")
      ->check(CLI::Range(0.005, kMostMetresPerPx))
      ->capture_default_str();
  auto* merge = addAction(
      command, "merge", "Add the map of a later drive (run --map) to a saved one",
      "parkade map merge OUT/map.db LATER/map.db --out garage.db", a, exit_code, mergeMaps);
  merge->add_option("LATER", a->later, "Map (or run folder) of the drive that was localised in MAP")
      ->required();
  merge->add_option("-o,--out", a->out, "Map file to write; may be MAP itself")->required();
  command->footer(
      "Examples:\n"
      "  parkade map info OUT/map.db\n"
      "  parkade map check OUT/map.db\n"
      "  parkade map export OUT/map.db --out OUT/map --format nav2,geojson\n"
      "  parkade map merge OUT/map.db LATER/map.db --out garage.db");
}

}  // namespace parkade::cli
