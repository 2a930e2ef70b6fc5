// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/storage/map_export.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "parkade/core/json_text.hpp"
#include "parkade/core/markup.hpp"
#include "parkade/mapping/storage/map_drawing.hpp"

namespace parkade {
namespace {

using nlohmann::json;

Status writeFile(const std::string& path, const std::string& content) {
  const std::string temporary = path + ".tmp";
  {
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.flush();
    if (!stream) {
      std::remove(temporary.c_str());
      return Error{
          fmt::format("{}: cannot be written (does the folder exist, is the disk full?)", path)};
    }
  }
  std::error_code code;
  std::filesystem::rename(temporary, path, code);
  if (code) return Error{fmt::format("{}: cannot be written: {}", path, code.message())};
  return {};
}

LayeredGrid::Bounds boundsOf(const ParkingMap& map) {
  return map.grid.bounds().value_or(LayeredGrid::Bounds{});
}

json pointJson(const Eigen::Vector2d& p) {
  return json::array({p.x(), p.y()});
}

// A closed, counter-clockwise ring.
template <class Points>
json ringJson(const Points& points) {
  double twice_area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d& a = points[i];
    const Eigen::Vector2d& b = points[(i + 1) % points.size()];
    twice_area += a.x() * b.y() - b.x() * a.y();
  }
  json ring = json::array();
  for (const Eigen::Vector2d& p : points) ring.push_back(pointJson(p));
  if (twice_area < 0.0) std::reverse(ring.begin(), ring.end());
  ring.push_back(ring.front());
  return json::array({ring});
}

const char* shapeName(SlotShape shape) {
  switch (shape) {
    case SlotShape::kPerpendicular:
      return "perpendicular";
    case SlotShape::kParallel:
      return "parallel";
    case SlotShape::kSlanted:
      return "slanted";
  }
  return "unknown";
}

json slotFeature(const MapSlot& slot) {
  return {{"type", "Feature"},
          {"id", fmt::format("slot-{}", slot.id)},
          {"geometry", {{"type", "Polygon"}, {"coordinates", ringJson(slot.corners)}}},
          {"properties",
           {{"kind", "parking_space"},
            {"shape", shapeName(slot.shape)},
            {"number", slot.number},
            {"zone", slot.zone},
            {"probability_free", slot.probability_free},
            {"corner_sigma_m", slot.corner_sigma},
            {"entrance", json::array({pointJson(slot.corners[0]), pointJson(slot.corners[1])})},
            {"observations", slot.observations},
            {"last_seen_ns", slot.last_seen_ns}}}};
}

json objectFeature(const MapObject& object) {
  json geometry = {{"type", "Point"}, {"coordinates", pointJson(object.position.head<2>())}};
  if (object.outline.size() >= 3) {
    geometry = {{"type", "Polygon"}, {"coordinates", ringJson(object.outline)}};
  }
  return {{"type", "Feature"},
          {"id", fmt::format("object-{}", object.id)},
          {"geometry", geometry},
          {"properties",
           {{"kind", kSemanticClassNames[static_cast<std::size_t>(object.semantic_class)]},
            {"text", object.text},
            {"heading_rad", object.heading},
            {"height_m", object.position.z()},
            {"position_sigma_m", object.position_sigma},
            {"observations", object.observations}}}};
}

// Lanelet2's OSM, one element after the other with ids of its own.
class OsmWriter {
 public:
  int node(const Eigen::Vector2d& p) {
    // Nominal: readers of local maps use local_x and local_y.
    constexpr double kMetresPerDegree = 111319.49;
    nodes_ += fmt::format(
        "  <node id=\"{}\" lat=\"{:.9f}\" lon=\"{:.9f}\">\n"
        "    <tag k=\"local_x\" v=\"{:.4f}\"/>\n    <tag k=\"local_y\" v=\"{:.4f}\"/>\n"
        "    <tag k=\"ele\" v=\"0\"/>\n  </node>\n",
        next_id_, p.y() / kMetresPerDegree, p.x() / kMetresPerDegree, p.x(), p.y());
    return next_id_++;
  }
  void way(const std::vector<int>& nodes,
           const std::vector<std::pair<std::string, std::string>>& tags) {
    ways_ += fmt::format("  <way id=\"{}\">\n", next_id_++);
    for (const int id : nodes) ways_ += fmt::format("    <nd ref=\"{}\"/>\n", id);
    for (const auto& [key, value] : tags) {
      ways_ += fmt::format("    <tag k=\"{}\" v=\"{}\"/>\n", key, escapedMarkup(value));
    }
    ways_ += "  </way>\n";
  }
  [[nodiscard]] std::string text() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<osm version=\"0.6\" "
           "generator=\"parkade\">\n"
           "  <MetaInfo format_version=\"1\" map_version=\"1\"/>\n" +
           nodes_ + ways_ + "</osm>\n";
  }

 private:
  int next_id_ = 1;
  std::string nodes_;
  std::string ways_;
};

// Convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points) {
  const auto less = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(points.begin(), points.end(), less);
  std::vector<Eigen::Vector2d> hull;
  const auto extend = [&](const Eigen::Vector2d& p, std::size_t keep) {
    while (hull.size() >= keep + 2) {
      const Eigen::Vector2d a = hull[hull.size() - 1] - hull[hull.size() - 2];
      const Eigen::Vector2d b = p - hull[hull.size() - 1];
      if (a.x() * b.y() - a.y() * b.x() > 0.0) break;
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Eigen::Vector2d& p : points) extend(p, 0);
  const std::size_t lower = hull.size();
  for (auto it = points.rbegin() + 1; it != points.rend(); ++it) extend(*it, lower - 1);
  hull.pop_back();
  return hull;
}

}  // namespace

Eigen::Vector2d nav2PictureSize(const ParkingMap& map) {
  const LayeredGrid::Bounds bounds = boundsOf(map);
  return (bounds.max - bounds.min + Eigen::Vector2i::Ones()).cast<double>();
}

Status exportNav2(const ParkingMap& map, GridLayer layer, const std::string& folder) {
  const LayeredGrid::Bounds bounds = boundsOf(map);
  if (const Status fits = checkPictureSize(nav2PictureSize(map)); !fits) return fits;
  const int width = bounds.max.x() - bounds.min.x() + 1;
  const int height = bounds.max.y() - bounds.min.y() + 1;
  const std::string name(kGridLayerNames[static_cast<std::size_t>(layer)]);
  std::string pgm = fmt::format("P5\n{} {}\n255\n", width, height);
  pgm.reserve(pgm.size() + static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  constexpr char kPresent = 0;
  constexpr char kAbsent = static_cast<char>(254);
  constexpr char kUnknown = static_cast<char>(205);
  for (int y = bounds.max.y(); y >= bounds.min.y(); --y) {
    for (int x = bounds.min.x(); x <= bounds.max.x(); ++x) {
      const GridCell cell = map.grid.at(layer, {x, y});
      const bool absent = cell.semantic_class == SemanticClass::kFloor || cell.log_odds < 0;
      pgm += !cell.known() || cell.log_odds == 0 ? kUnknown : absent ? kAbsent : kPresent;
    }
  }
  const Eigen::Vector2d origin = map.grid.resolution() * bounds.min.cast<double>();
  // 205 means an occupancy of 0.196: free_thresh must lie below it, or unknown reads as free.
  const std::string yaml = fmt::format(
      "image: {}.pgm\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0.0]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.15\n",
      name, map.grid.resolution(), origin.x(), origin.y());
  const Status picture = writeFile(folder + "/" + name + ".pgm", pgm);
  if (!picture) return picture;
  return writeFile(folder + "/" + name + ".yaml", yaml);
}

Status exportGeoJson(const ParkingMap& map, const std::string& path) {
  json features = json::array();
  for (const MapSlot& slot : map.slots) features.push_back(slotFeature(slot));
  for (const MapObject& object : map.objects) features.push_back(objectFeature(object));
  const json document = {{"type", "FeatureCollection"},
                         {"name", map.name},
                         {"coordinate_reference",
                          {{"type", "local"},
                           {"unit", "metre"},
                           {"axes", "x, y in the ground plane, right-handed, z up"}}},
                         {"features", features}};
  // Text of a damaged file need not be UTF-8.
  return writeFile(path, jsonText(document, 1));
}

Status exportLanelet2(const ParkingMap& map, const std::string& path) {
  OsmWriter osm;
  std::vector<Eigen::Vector2d> all;
  for (const MapSlot& slot : map.slots) {
    const auto& c = slot.corners;
    all.insert(all.end(), c.begin(), c.end());
    const Eigen::Vector2d entrance = slot.entrance();
    const Eigen::Vector2d rear = 0.5 * (c[2] + c[3]);
    // The slot's extent across its own axis, so that slanted slots keep their area.
    const Eigen::Vector2d axis = (rear - entrance).normalized();
    const Eigen::Vector2d across(-axis.y(), axis.x());
    const double width = std::abs(across.dot(c[1] - c[0]));
    osm.way({osm.node(entrance), osm.node(rear)}, {{"type", "parking_space"},
                                                   {"width", fmt::format("{:.3f}", width)},
                                                   {"parkade:id", fmt::format("{}", slot.id)},
                                                   {"ref", slot.number}});
  }
  if (all.size() >= 3) {
    // Lanelet2's polygons run clockwise and are not closed.
    std::vector<Eigen::Vector2d> hull = convexHull(all);
    std::reverse(hull.begin(), hull.end());
    std::vector<int> corners;
    for (const Eigen::Vector2d& p : hull) corners.push_back(osm.node(p));
    osm.way(corners, {{"type", "parking_lot"}, {"area", "yes"}});
  }
  return writeFile(path, osm.text());
}

}  // namespace parkade
