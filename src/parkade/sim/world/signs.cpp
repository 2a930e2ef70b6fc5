// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/sim/world/aisle_graph.hpp"
#include "parkade/sim/world/generate.hpp"
#include "parkade/sim/world/paint.hpp"
#include "parkade/sim/world/stroke_font.hpp"
#include "parkade/sim/world/structure.hpp"

namespace parkade::sim {
namespace {

/// A sign that is read by somebody who looks along `heading` (rad).
SE3 signPose(const Eigen::Vector3d& center, double heading) {
  const Eigen::Vector3d z(-std::cos(heading), -std::sin(heading), 0.0);
  const Eigen::Vector3d y = Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d axes;
  axes << y.cross(z), y, z;
  return {SO3(axes), center};
}

Sign& addSign(Garage& garage, SemanticClass semantic_class, const SE3& pose, double width,
              double height, const std::string& text) {
  Sign sign;
  sign.id = static_cast<int>(garage.signs.size()) + 1;
  sign.semantic_class = semantic_class;
  sign.T_world_sign = pose;
  sign.width = width;
  sign.height = height;
  sign.text = text;
  garage.signs.push_back(std::move(sign));
  return garage.signs.back();
}

std::string zoneName(const GarageStyle& style, std::size_t row, std::size_t column) {
  const std::size_t first = kZoneLetters.find(style.first_zone);
  const std::string letter(1, kZoneLetters[(first + row) % kZoneLetters.size()]);
  const std::string number = std::to_string(column + 1);
  switch (style.zone_scheme) {
    case 1:
      return letter + "-" + number;
    case 2:
      return letter + (number.size() < 2 ? "0" + number : number);
    case 3:
      return number + letter;
    default:
      return letter + number;
  }
}

std::size_t indexOf(const std::vector<double>& lines, double value) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (std::abs(lines[i] - value) < std::abs(lines[best] - value)) best = i;
  }
  return best;
}

void addZoneMarkers(const Layout& layout, const GarageStyle& style, Random random, Garage& garage) {
  for (Pillar& pillar : garage.pillars) {
    if (!random.chance(style.zone_share)) continue;
    pillar.zone_text = zoneName(style, indexOf(layout.pillar_y, pillar.center.y()),
                                indexOf(layout.pillar_x, pillar.center.x()));
    const double room = 0.86 * zonePlateWidth(pillar);
    double height = style.zone_text_height;
    const double full = textWidth(pillar.zone_text, height, style.text_weight);
    height *= std::min(1.0, room / full);
    const double width = textWidth(pillar.zone_text, height, style.text_weight);
    const double z = garage.floorHeight(pillar.center) + style.zone_text_center;
    for (int face = 0; face < 4; ++face) {
      if (style.zone_faces == 2 && face % 2 == 0) continue;
      const double heading = face * M_PI_2;  // of the reader
      const Eigen::Vector2d normal(-std::cos(heading), -std::sin(heading));
      const double out = 0.5 * pillar.size.x() + (pillar.round ? 0.03 : 0.004);
      const Eigen::Vector2d p = pillar.center + out * normal;
      addSign(garage, SemanticClass::kZoneMarker, signPose({p.x(), p.y(), z}, heading),
              width + kZoneTextMargin, height + kZoneTextMargin, pillar.zone_text);
    }
  }
}

void nameZonesOfSlots(Garage& garage) {
  for (Slot& slot : garage.slots) {
    const Eigen::Vector2d middle =
        0.25 * (slot.corners[0] + slot.corners[1] + slot.corners[2] + slot.corners[3]);
    double best = std::numeric_limits<double>::infinity();
    for (const Pillar& pillar : garage.pillars) {
      const double distance = (pillar.center - middle).squaredNorm();
      if (pillar.zone_text.empty() || distance >= best) continue;
      best = distance;
      slot.zone = pillar.zone_text;
    }
  }
}

/// Words for a hanging sign ahead of a crossing: the way out, or what lies ahead.
std::string guideText(const Garage& garage, const std::vector<int>& way_out, int before, int node,
                      Random& random) {
  const int next = way_out.empty() ? -1 : way_out[static_cast<std::size_t>(node)];
  if (next >= 0 && next != before && random.chance(0.7)) {
    const std::string turn = turnTo(garage.aisles, before, node, next);
    return turn == "left" ? "exit_left" : turn == "right" ? "exit_right" : "exit_straight";
  }
  if (next == -1 && !way_out.empty()) return "EXIT";
  const std::string turns = turnsAt(garage.aisles, before, node);
  const char* word = random.chance(0.6) ? "parking" : "lift";
  if (turns.find("straight") != std::string::npos) return std::string(word) + "_straight";
  return std::string(word) + (turns.find("left") != std::string::npos ? "_left" : "_right");
}

int nodeNearest(const AisleGraph& graph, const Eigen::Vector2d& p) {
  int best = 0;
  for (std::size_t i = 1; i < graph.nodes.size(); ++i) {
    if ((graph.nodes[i] - p).norm() < (graph.nodes[static_cast<std::size_t>(best)] - p).norm()) {
      best = static_cast<int>(i);
    }
  }
  return best;
}

void addGuideSigns(const GarageStyle& style, Random random, Garage& garage) {
  std::vector<int> way_out;
  if (!garage.entrances.empty()) {
    way_out =
        nextTowards(garage.aisles, nodeNearest(garage.aisles, garage.entrances.front().center));
  }
  constexpr double kWidth = 1.7;
  constexpr double kHeight = 0.42;
  for (const AisleGraph::Edge& edge : garage.aisles.edges) {
    for (const bool backward : {false, true}) {
      if (backward && edge.one_way) break;
      const int before = backward ? edge.to : edge.from;
      const int node = backward ? edge.from : edge.to;
      if (!random.chance(style.guide_share)) continue;
      const Eigen::Vector2d a = garage.aisles.nodes[static_cast<std::size_t>(before)];
      const Eigen::Vector2d b = garage.aisles.nodes[static_cast<std::size_t>(node)];
      const double heading = std::atan2(b.y() - a.y(), b.x() - a.x());
      const double s = (b - a).norm() - 0.5 * edge.width - random.uniform(0.6, 1.8);
      if (s < 0.5 * edge.width + 2.0) continue;
      const Eigen::Vector2d p = Frame2{a, heading} * Eigen::Vector2d(s, -0.22 * edge.width);
      const double floor = garage.floorHeight(p);
      const double z = std::max(floor + 2.1 + 0.5 * kHeight,
                                std::min(floor + 2.25, garage.ceiling_height - 0.35));
      addSign(garage, SemanticClass::kGuideSign, signPose({p.x(), p.y(), z}, heading), kWidth,
              kHeight, guideText(garage, way_out, before, node, random));
    }
  }
}

/// Round plates on pillars, above the zone text, read by drivers who go along the aisle.
void addLimitSigns(const GarageStyle& style, Random random, Garage& garage) {
  constexpr double kDiameter = 0.5;
  const std::string text = std::to_string(static_cast<int>(std::lround(style.limit_kmh)));
  for (const Pillar& pillar : garage.pillars) {
    if (!random.chance(style.limit_sign_share)) continue;
    const double heading = random.index(4) * M_PI_2;
    const Eigen::Vector2d normal(-std::cos(heading), -std::sin(heading));
    const Eigen::Vector2d p = pillar.center + (0.5 * pillar.size.x() + 0.05) * normal;
    const double top = garage.ceiling_height - garage.floorHeight(pillar.center);
    const double z = std::min(style.zone_text_center + 0.5 * style.zone_text_height + 0.35,
                              top - 0.5 * kDiameter - 0.05);
    addSign(garage, SemanticClass::kSpeedLimitSign,
            signPose({p.x(), p.y(), garage.floorHeight(pillar.center) + z}, heading), kDiameter,
            kDiameter, text);
  }
}

}  // namespace

void placeSigns(const Layout& layout, const GarageStyle& style, Random random, Garage& garage) {
  addZoneMarkers(layout, style, random.fork("zone"), garage);
  nameZonesOfSlots(garage);
  addGuideSigns(style, random.fork("guide"), garage);
  addLimitSigns(style, random.fork("limit"), garage);
}

}  // namespace parkade::sim
