// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/core/random.hpp"
#include "parkade/mapping/parking_map.hpp"

// For tests only: a map with something of everything.

namespace parkade::testing {

inline ParkingMap sampleMap(std::uint64_t seed = 1) {
  Random random(seed);
  ParkingMap map;
  map.name = "sample";
  for (const GridLayer layer : kGridLayers) {
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector2d p(random.uniform(-12.0, 20.0), random.uniform(-8.0, 9.0));
      map.grid.add(layer, p, static_cast<SemanticClass>(random.integer(1, kNumSemanticClasses - 1)),
                   static_cast<float>(random.uniform(0.2, 3.0)));
    }
  }
  for (int i = 0; i < 6; ++i) {
    MapSlot slot;
    slot.id = 10 + i;
    const double x = 2.5 * i;
    slot.corners = {Eigen::Vector2d(x + 2.5, 3.0), Eigen::Vector2d(x, 3.0), Eigen::Vector2d(x, 8.0),
                    Eigen::Vector2d(x + 2.5, 8.0)};
    slot.corner_sigma = 0.021;
    slot.number = i == 3 ? "" : std::to_string(100 + i);
    slot.zone = "B2 & \"C\" <1>";
    slot.probability_free = i % 2 == 0 ? 0.97 : 0.04;
    slot.observations = 17 + i;
    slot.last_seen_ns = 1'403'636'580'838'555'648 + i;
    map.slots.push_back(slot);
  }
  MapObject arrow;
  arrow.id = 3;
  arrow.semantic_class = SemanticClass::kArrow;
  arrow.position = {1.0, -2.0, 0.0};
  arrow.heading = 1.5;
  arrow.text = "straight_left";
  arrow.outline = {{0.0, -2.0}, {2.0, -2.2}, {2.0, -1.8}};
  MapObject marker;
  marker.id = 4;
  marker.semantic_class = SemanticClass::kZoneMarker;
  marker.position = {5.0, 3.0, 1.6};
  marker.text = "B12";
  map.objects = {arrow, marker};
  for (int i = 0; i < 4; ++i) {
    map.nodes.push_back(
        {i, 1000 * i, SE3(SO3::fromYawPitchRoll(0.1 * i, 0.01, 0.0), {1.0 * i, 0, 0})});
    if (i == 0) continue;
    PoseGraphEdge edge;
    edge.from = i - 1;
    edge.to = i;
    edge.kind = i == 3 ? EdgeKind::kLoop : EdgeKind::kOdometry;
    edge.T_from_to = map.nodes[i - 1].T_world_vehicle.inverse() * map.nodes[i].T_world_vehicle;
    edge.information = 100.0 * Matrix6d::Identity();
    map.edges.push_back(edge);
  }
  return map;
}

}  // namespace parkade::testing
