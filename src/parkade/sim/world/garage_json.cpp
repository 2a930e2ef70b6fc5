// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/garage_json.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace parkade::sim {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;
constexpr std::array<const char*, 3> kSlotTypes = {"perpendicular", "parallel", "slanted"};
constexpr std::array<const char*, 4> kSlotMarkings = {"closed", "t_shaped", "l_shaped", "open"};

/// Thrown by the readers below and turned into an Error at the border.
struct FormatError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

json toJson(const Eigen::Vector2d& p) {
  return json::array({p.x(), p.y()});
}

template <class Points>
json pointsJson(const Points& points) {
  json out = json::array();
  for (const Eigen::Vector2d& p : points) out.push_back(toJson(p));
  return out;
}

const json& at(const json& node, const char* key) {
  const auto it = node.find(key);
  if (it == node.end()) throw FormatError(fmt::format("key '{}' is missing", key));
  return *it;
}

template <class T>
T get(const json& node, const char* key) {
  try {
    return at(node, key).get<T>();
  } catch (const json::exception&) {
    throw FormatError(fmt::format("key '{}' has the unfit value {}", key, at(node, key).dump()));
  }
}

Eigen::Vector2d toPoint(const json& node) {
  if (!node.is_array() || node.size() != 2 || !node[0].is_number() || !node[1].is_number()) {
    throw FormatError(fmt::format("{} is no point [x, y]", node.dump()));
  }
  return {node[0].get<double>(), node[1].get<double>()};
}

std::vector<Eigen::Vector2d> toPoints(const json& node) {
  if (!node.is_array()) throw FormatError(fmt::format("{} is no list of points", node.dump()));
  std::vector<Eigen::Vector2d> out;
  for (const json& p : node) out.push_back(toPoint(p));
  return out;
}

/// Index of a word in a list of names.
template <class Names>
std::size_t indexOf(const Names& names, const std::string& word, const char* key) {
  const auto it = std::find(names.begin(), names.end(), word);
  if (it == names.end()) throw FormatError(fmt::format("key '{}': '{}' is unknown", key, word));
  return static_cast<std::size_t>(it - names.begin());
}

SemanticClass toClass(const json& node) {
  return static_cast<SemanticClass>(
      indexOf(kSemanticClassNames, get<std::string>(node, "class"), "class"));
}

std::string nameOf(SemanticClass semantic_class) {
  return std::string(kSemanticClassNames[static_cast<std::size_t>(semantic_class)]);
}

json poseJson(const SE3& pose) {
  const Eigen::Vector3d& t = pose.translation();
  const Eigen::Quaterniond& q = pose.rotation().quaternion();
  return {{"position", {t.x(), t.y(), t.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

SE3 toPose(const json& node) {
  const auto t = get<std::array<double, 3>>(node, "position");
  const auto q = get<std::array<double, 4>>(node, "quaternion_xyzw");
  return {SO3(Eigen::Quaterniond(q[3], q[0], q[1], q[2])), {t[0], t[1], t[2]}};
}

json slotJson(const Slot& slot) {
  return {{"id", slot.id},
          {"corners", pointsJson(slot.corners)},
          {"type", kSlotTypes[static_cast<std::size_t>(slot.type)]},
          {"marking", kSlotMarkings[static_cast<std::size_t>(slot.marking)]},
          {"number", slot.number},
          {"zone", slot.zone},
          {"occupied", slot.occupied}};
}

Slot toSlot(const json& node) {
  Slot slot;
  slot.id = get<int>(node, "id");
  const std::vector<Eigen::Vector2d> corners = toPoints(at(node, "corners"));
  if (corners.size() != 4) throw FormatError("key 'corners' has not four points");
  std::copy(corners.begin(), corners.end(), slot.corners.begin());
  slot.type = static_cast<SlotType>(indexOf(kSlotTypes, get<std::string>(node, "type"), "type"));
  slot.marking = static_cast<SlotMarking>(
      indexOf(kSlotMarkings, get<std::string>(node, "marking"), "marking"));
  slot.number = get<std::string>(node, "number");
  slot.zone = get<std::string>(node, "zone");
  slot.occupied = get<bool>(node, "occupied");
  return slot;
}

json markingJson(const Marking& marking) {
  json polygons = json::array();
  for (const auto& polygon : marking.polygons) polygons.push_back(pointsJson(polygon));
  return {{"id", marking.id},
          {"class", nameOf(marking.semantic_class)},
          {"polygons", polygons},
          {"meaning", marking.meaning},
          {"position", toJson(marking.position)},
          {"heading", marking.heading},
          {"colour", {marking.colour.x(), marking.colour.y(), marking.colour.z()}}};
}

Marking toMarking(const json& node) {
  Marking marking;
  marking.id = get<int>(node, "id");
  marking.semantic_class = toClass(node);
  for (const json& polygon : at(node, "polygons")) marking.polygons.push_back(toPoints(polygon));
  marking.meaning = get<std::string>(node, "meaning");
  marking.position = toPoint(at(node, "position"));
  marking.heading = get<double>(node, "heading");
  const auto colour = get<std::array<float, 3>>(node, "colour");
  marking.colour = {colour[0], colour[1], colour[2]};
  return marking;
}

json pillarJson(const Pillar& pillar) {
  return {{"id", pillar.id},
          {"center", toJson(pillar.center)},
          {"size", toJson(pillar.size)},
          {"height", pillar.height},
          {"round", pillar.round},
          {"zone_text", pillar.zone_text}};
}

Pillar toPillar(const json& node) {
  Pillar pillar;
  pillar.id = get<int>(node, "id");
  pillar.center = toPoint(at(node, "center"));
  pillar.size = toPoint(at(node, "size"));
  pillar.height = get<double>(node, "height");
  pillar.round = get<bool>(node, "round");
  pillar.zone_text = get<std::string>(node, "zone_text");
  return pillar;
}

json signJson(const Sign& sign) {
  return {{"id", sign.id},
          {"class", nameOf(sign.semantic_class)},
          {"T_world_sign", poseJson(sign.T_world_sign)},
          {"width", sign.width},
          {"height", sign.height},
          {"text", sign.text}};
}

Sign toSign(const json& node) {
  Sign sign;
  sign.id = get<int>(node, "id");
  sign.semantic_class = toClass(node);
  sign.T_world_sign = toPose(at(node, "T_world_sign"));
  sign.width = get<double>(node, "width");
  sign.height = get<double>(node, "height");
  sign.text = get<std::string>(node, "text");
  return sign;
}

json aislesJson(const AisleGraph& graph) {
  json edges = json::array();
  for (const AisleGraph::Edge& edge : graph.edges) {
    edges.push_back({{"from", edge.from},
                     {"to", edge.to},
                     {"width", edge.width},
                     {"one_way", edge.one_way},
                     {"speed_limit", edge.speed_limit}});
  }
  return {{"nodes", pointsJson(graph.nodes)}, {"edges", edges}};
}

AisleGraph toAisles(const json& node) {
  AisleGraph graph;
  graph.nodes = toPoints(at(node, "nodes"));
  const int count = static_cast<int>(graph.nodes.size());
  for (const json& item : at(node, "edges")) {
    AisleGraph::Edge edge;
    edge.from = get<int>(item, "from");
    edge.to = get<int>(item, "to");
    edge.width = get<double>(item, "width");
    edge.one_way = get<bool>(item, "one_way");
    edge.speed_limit = get<double>(item, "speed_limit");
    if (std::min(edge.from, edge.to) < 0 || std::max(edge.from, edge.to) >= count) {
      throw FormatError(fmt::format("edge {} names a node that is not there", item.dump()));
    }
    graph.edges.push_back(edge);
  }
  return graph;
}

json groundJson(const Garage& garage) {
  json ramps = json::array();
  for (const Garage::Ramp& ramp : garage.ramps) {
    ramps.push_back({{"start", toJson(ramp.start)},
                     {"direction", toJson(ramp.direction)},
                     {"length", ramp.length},
                     {"rise", ramp.rise}});
  }
  json bumps = json::array();
  for (const Garage::Bump& bump : garage.bumps) {
    bumps.push_back({{"center", toJson(bump.center)},
                     {"heading", bump.heading},
                     {"length", bump.length},
                     {"width", bump.width},
                     {"height", bump.height}});
  }
  return {{"ramps", ramps}, {"bumps", bumps}};
}

void readGround(const json& node, Garage& garage) {
  for (const json& item : at(node, "ramps")) {
    garage.ramps.push_back({toPoint(at(item, "start")), toPoint(at(item, "direction")),
                            get<double>(item, "length"), get<double>(item, "rise")});
  }
  for (const json& item : at(node, "bumps")) {
    garage.bumps.push_back({toPoint(at(item, "center")), get<double>(item, "heading"),
                            get<double>(item, "length"), get<double>(item, "width"),
                            get<double>(item, "height")});
  }
}

template <class Items, class ToJson>
json listJson(const Items& items, ToJson to_json) {
  json out = json::array();
  for (const auto& item : items) out.push_back(to_json(item));
  return out;
}

/// Reads a list; a failure names the list and the place in it.
template <class Item, class Read>
void readList(const json& root, const char* key, std::vector<Item>& out, Read read) {
  const json& list = at(root, key);
  if (!list.is_array()) throw FormatError(fmt::format("key '{}' is no list", key));
  for (std::size_t i = 0; i < list.size(); ++i) {
    try {
      out.push_back(read(list[i]));
    } catch (const FormatError& error) {
      throw FormatError(fmt::format("{}[{}]: {}", key, i, error.what()));
    }
  }
}

Garage toGarage(const json& root) {
  if (const int version = get<int>(root, "version"); version != kVersion) {
    throw FormatError(
        fmt::format("version {} is not {}, the one this program reads", version, kVersion));
  }
  Garage garage;
  garage.name = get<std::string>(root, "name");
  garage.seed = get<std::uint64_t>(root, "seed");
  garage.min = toPoint(at(root, "min"));
  garage.max = toPoint(at(root, "max"));
  garage.outline = toPoints(at(root, "outline"));
  garage.ceiling_height = get<double>(root, "ceiling_height");
  garage.line_width = get<double>(root, "line_width");
  readList(root, "slots", garage.slots, toSlot);
  readList(root, "markings", garage.markings, toMarking);
  readList(root, "pillars", garage.pillars, toPillar);
  readList(root, "signs", garage.signs, toSign);
  readList(root, "rooms", garage.rooms, [](const json& node) {
    return Room{get<int>(node, "id"), toPoint(at(node, "min")), toPoint(at(node, "max"))};
  });
  readList(root, "entrances", garage.entrances, [](const json& node) {
    return Entrance{toPoint(at(node, "center")), get<double>(node, "heading"),
                    get<double>(node, "width")};
  });
  garage.aisles = toAisles(at(root, "aisles"));
  readGround(at(root, "ground"), garage);
  return garage;
}

}  // namespace

std::string garageTruthText(const Garage& garage) {
  nlohmann::ordered_json root;
  root["format"] = "parkade garage";
  root["version"] = kVersion;
  root["name"] = garage.name;
  root["seed"] = garage.seed;
  root["min"] = toJson(garage.min);
  root["max"] = toJson(garage.max);
  root["outline"] = pointsJson(garage.outline);
  root["ceiling_height"] = garage.ceiling_height;
  root["line_width"] = garage.line_width;
  root["slots"] = listJson(garage.slots, slotJson);
  root["markings"] = listJson(garage.markings, markingJson);
  root["pillars"] = listJson(garage.pillars, pillarJson);
  root["signs"] = listJson(garage.signs, signJson);
  root["rooms"] = listJson(garage.rooms, [](const Room& room) {
    return json{{"id", room.id}, {"min", toJson(room.min)}, {"max", toJson(room.max)}};
  });
  root["entrances"] = listJson(garage.entrances, [](const Entrance& entrance) {
    return json{{"center", toJson(entrance.center)},
                {"heading", entrance.heading},
                {"width", entrance.width}};
  });
  root["aisles"] = aislesJson(garage.aisles);
  root["ground"] = groundJson(garage);
  return root.dump(1) + "\n";
}

Status writeGarageTruth(const Garage& garage, const std::string& path) {
  const std::string part = path + ".part";
  {
    std::ofstream stream(part, std::ios::binary);
    stream << garageTruthText(garage);
    stream.flush();
    if (!stream) {
      std::remove(part.c_str());
      return Error{part + ": cannot be written; check that the folder exists and has space"};
    }
  }
  if (std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    return Error{path + ": cannot be replaced"};
  }
  return {};
}

Result<Garage> readGarageTruth(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Error{path + ": cannot be opened"};
  try {
    return toGarage(json::parse(stream));
  } catch (const json::exception& error) {
    return Error{fmt::format("{}: {}", path, error.what())};
  } catch (const FormatError& error) {
    return Error{fmt::format("{}: {}", path, error.what())};
  }
}

}  // namespace parkade::sim
