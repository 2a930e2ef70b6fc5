// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Reads garage.json.
#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "parkade/sim/world/garage_json.hpp"
#include "parkade/sim/world/garage_json_names.hpp"

namespace parkade::sim {
namespace {

using nlohmann::json;

/// Thrown by the readers below and turned into an Error at the border.
struct FormatError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

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

SE3 toPose(const json& node) {
  const auto t = get<std::array<double, 3>>(node, "position");
  const auto q = get<std::array<double, 4>>(node, "quaternion_xyzw");
  return {SO3(Eigen::Quaterniond(q[3], q[0], q[1], q[2])), {t[0], t[1], t[2]}};
}

Slot toSlot(const json& node) {
  Slot slot;
  slot.id = get<int>(node, "id");
  const std::vector<Eigen::Vector2d> corners = toPoints(at(node, "corners"));
  if (corners.size() != 4) throw FormatError("key 'corners' has not four points");
  std::copy(corners.begin(), corners.end(), slot.corners.begin());
  slot.type =
      static_cast<SlotType>(indexOf(kSlotTypeNames, get<std::string>(node, "type"), "type"));
  slot.marking = static_cast<SlotMarking>(
      indexOf(kSlotMarkingNames, get<std::string>(node, "marking"), "marking"));
  slot.number = get<std::string>(node, "number");
  slot.zone = get<std::string>(node, "zone");
  slot.occupied = get<bool>(node, "occupied");
  return slot;
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
  if (const int version = get<int>(root, "version"); version != kGarageVersion) {
    throw FormatError(
        fmt::format("version {} is not {}, the one this program reads", version, kGarageVersion));
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
