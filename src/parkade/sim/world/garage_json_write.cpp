// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Writes garage.json.
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "parkade/sim/world/garage_json.hpp"
#include "parkade/sim/world/garage_json_names.hpp"

namespace parkade::sim {
namespace {

using nlohmann::json;

json toJson(const Eigen::Vector2d& p) {
  return json::array({p.x(), p.y()});
}

template <class Points>
json pointsJson(const Points& points) {
  json out = json::array();
  for (const Eigen::Vector2d& p : points) out.push_back(toJson(p));
  return out;
}

std::string nameOf(SemanticClass semantic_class) {
  return std::string(kSemanticClassNames[static_cast<std::size_t>(semantic_class)]);
}

json poseJson(const SE3& pose) {
  const Eigen::Vector3d& t = pose.translation();
  const Eigen::Quaterniond& q = pose.rotation().quaternion();
  return {{"position", {t.x(), t.y(), t.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

json slotJson(const Slot& slot) {
  return {{"id", slot.id},
          {"corners", pointsJson(slot.corners)},
          {"type", kSlotTypeNames[static_cast<std::size_t>(slot.type)]},
          {"marking", kSlotMarkingNames[static_cast<std::size_t>(slot.marking)]},
          {"number", slot.number},
          {"zone", slot.zone},
          {"occupied", slot.occupied}};
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

json pillarJson(const Pillar& pillar) {
  return {{"id", pillar.id},
          {"center", toJson(pillar.center)},
          {"size", toJson(pillar.size)},
          {"height", pillar.height},
          {"round", pillar.round},
          {"zone_text", pillar.zone_text}};
}

json signJson(const Sign& sign) {
  return {{"id", sign.id},
          {"class", nameOf(sign.semantic_class)},
          {"T_world_sign", poseJson(sign.T_world_sign)},
          {"width", sign.width},
          {"height", sign.height},
          {"text", sign.text}};
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

template <class Items, class ToJson>
json listJson(const Items& items, ToJson to_json) {
  json out = json::array();
  for (const auto& item : items) out.push_back(to_json(item));
  return out;
}

}  // namespace

std::string garageTruthText(const Garage& garage) {
  nlohmann::ordered_json root;
  root["format"] = "parkade garage";
  root["version"] = kGarageVersion;
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

}  // namespace parkade::sim
