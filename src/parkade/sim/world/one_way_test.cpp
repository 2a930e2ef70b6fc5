// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/one_way.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "parkade/sim/drive/routes.hpp"
#include "parkade/sim/world/agent_tracks.hpp"
#include "parkade/sim/world/aisle_graph.hpp"
#include "parkade/sim/world/garage_json.hpp"
#include "parkade/sim/world/generate.hpp"
#include "parkade/sim/world/polygon.hpp"

namespace parkade::sim {
namespace {

Garage make(int seed, double one_way) {
  GarageOptions options;
  options.preset = "random";
  options.seed = seed;
  options.one_way = one_way;
  return generateGarage(options).value();
}

int oneWayCount(const Garage& garage) {
  return static_cast<int>(std::count_if(garage.aisles.edges.begin(), garage.aisles.edges.end(),
                                        [](const AisleGraph::Edge& edge) { return edge.one_way; }));
}

/// A stretch of a one-way aisle: x along its direction.
struct Stretch {
  Frame2 frame;
  double length = 0.0;
  double width = 0.0;
  /// Whether a place lies on it, clear of the crossings at its ends.
  [[nodiscard]] bool holds(const Eigen::Vector2d& p, double clear) const {
    const Eigen::Vector2d at = frame.inverse(p);
    return at.x() > clear && at.x() < length - clear && std::abs(at.y()) < 0.5 * width;
  }
};

std::vector<Stretch> oneWayStretches(const Garage& garage) {
  std::vector<Stretch> stretches;
  for (const AisleGraph::Edge& edge : garage.aisles.edges) {
    if (!edge.one_way) continue;
    const Eigen::Vector2d a = garage.aisles.nodes[static_cast<std::size_t>(edge.from)];
    const Eigen::Vector2d d = garage.aisles.nodes[static_cast<std::size_t>(edge.to)] - a;
    stretches.push_back({{a, std::atan2(d.y(), d.x())}, d.norm(), edge.width});
  }
  return stretches;
}

TEST(OneWay, TheBuildingStaysAndMostGaragesGetSome) {
  int with_some = 0;
  for (int seed = 5000; seed < 5020; ++seed) {
    SCOPED_TRACE(seed);
    const Garage before = make(seed, 0.0);
    const Garage after = make(seed, 1.0);
    EXPECT_EQ(oneWayCount(before), 0);
    with_some += oneWayCount(after) > 0 ? 1 : 0;
    ASSERT_EQ(after.slots.size(), before.slots.size());
    for (std::size_t i = 0; i < after.slots.size(); ++i) {
      EXPECT_EQ(after.slots[i].corners, before.slots[i].corners);
      EXPECT_EQ(after.slots[i].occupied, before.slots[i].occupied);
    }
    ASSERT_EQ(after.pillars.size(), before.pillars.size());
    EXPECT_EQ(after.ceiling_height, before.ceiling_height);
    EXPECT_EQ(after.aisles.nodes, before.aisles.nodes);
    EXPECT_EQ(garageTruthText(make(seed, 1.0)), garageTruthText(after));
  }
  EXPECT_GE(with_some, 15);
}

TEST(OneWay, TheShareIsKeptOnTheWhole) {
  int edges = 0;
  int some = 0;
  int most = 0;
  for (int seed = 0; seed < 60; ++seed) {
    const Garage garage = make(seed, 0.4);
    edges += static_cast<int>(garage.aisles.edges.size());
    some += oneWayCount(garage);
    most += oneWayCount(make(seed, 1.0));
  }
  RecordProperty("edges", edges);
  RecordProperty("at_0.4", some);
  RecordProperty("at_1", most);
  EXPECT_GT(most, 0.6 * edges);
  EXPECT_NEAR(static_cast<double>(some) / most, 0.4, 0.15);
}

/// Walks as a driver does who never turns back; true where some start misses an aisle for good.
bool losesAnAisle(const AisleGraph& graph) {
  std::set<std::pair<int, int>> all;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    for (const int next : neighboursOf(graph, static_cast<int>(i))) {
      all.insert({static_cast<int>(i), next});
    }
  }
  for (const auto& start : all) {
    std::set<std::pair<int, int>> seen{start};
    std::vector<std::pair<int, int>> todo{start};
    while (!todo.empty()) {
      const auto [before, here] = todo.back();
      todo.pop_back();
      for (const int next : neighboursOf(graph, here)) {
        if (next != before && seen.insert({here, next}).second) todo.emplace_back(here, next);
      }
    }
    for (const AisleGraph::Edge& edge : graph.edges) {
      if (seen.count({edge.from, edge.to}) + seen.count({edge.to, edge.from}) == 0) return true;
    }
  }
  return false;
}

TEST(OneWay, EveryAisleStaysInReach) {
  for (int seed = 0; seed < 60; ++seed) {
    for (const double share : {0.3, 1.0}) {
      const Garage garage = make(seed, share);
      if (oneWayCount(garage) == 0) continue;
      EXPECT_FALSE(losesAnAisle(garage.aisles)) << "seed " << seed << ", share " << share;
    }
  }
}

TEST(OneWay, PaintPointsTheWay) {
  int arrows = 0;
  int stop_lines = 0;
  for (int seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const Garage garage = make(seed, 0.7);
    const std::vector<Stretch> stretches = oneWayStretches(garage);
    for (const Marking& marking : garage.markings) {
      for (const Stretch& stretch : stretches) {
        if (!stretch.holds(marking.position, 0.5 * stretch.width)) continue;
        EXPECT_NE(marking.meaning, "centre");
        if (marking.semantic_class != SemanticClass::kArrow &&
            marking.semantic_class != SemanticClass::kStopLine) {
          continue;
        }
        EXPECT_NEAR(std::cos(marking.heading - stretch.frame.heading), 1.0, 1e-9) << marking.id;
        EXPECT_NEAR(stretch.frame.inverse(marking.position).y(), 0.0, 1e-9) << marking.id;
        ++(marking.semantic_class == SemanticClass::kArrow ? arrows : stop_lines);
      }
    }
  }
  EXPECT_GT(arrows, 50);
  EXPECT_GT(stop_lines, 5);
}

/// The ways on at the crossing ahead of a place in an aisle, in the words of arrows; empty where no
/// crossing lies ahead within reach.
std::set<std::string> waysOn(const AisleGraph& graph, const Eigen::Vector2d& p, double heading) {
  constexpr double kReach = 12.0;  // m
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  std::set<std::string> ways;
  for (std::size_t node = 0; node < graph.nodes.size(); ++node) {
    const Eigen::Vector2d d = graph.nodes[node] - p;
    const double ahead = d.dot(along);
    if (ahead < 0.0 || ahead > kReach || (d - ahead * along).norm() > 2.5) continue;
    for (const int next : neighboursOf(graph, static_cast<int>(node))) {
      const Eigen::Vector2d on =
          (graph.nodes[static_cast<std::size_t>(next)] - graph.nodes[node]).normalized();
      const double left = along.x() * on.y() - along.y() * on.x();
      if (left > 0.7) ways.insert("left");
      if (left < -0.7) ways.insert("right");
    }
    return ways;
  }
  return {"left", "right"};
}

TEST(OneWay, ArrowsAskForNoTurnAgainstIt) {
  int turns = 0;
  for (int seed = 0; seed < 30; ++seed) {
    const Garage garage = make(seed, 0.7);
    for (const Marking& marking : garage.markings) {
      if (marking.semantic_class != SemanticClass::kArrow) continue;
      const std::set<std::string> ways = waysOn(garage.aisles, marking.position, marking.heading);
      for (const char* turn : {"left", "right"}) {
        if (marking.meaning.find(turn) == std::string::npos) continue;
        EXPECT_EQ(ways.count(turn), 1U)
            << "seed " << seed << ", marking " << marking.id << ": " << marking.meaning;
        ++turns;
      }
    }
  }
  EXPECT_GT(turns, 100);
}

TEST(OneWay, MovingCarsKeepToIt) {
  int places = 0;
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const Garage garage = make(seed, 1.0);
    const std::vector<Stretch> stretches = oneWayStretches(garage);
    Random random(static_cast<std::uint64_t>(seed));
    for (int car = 0; car < 10; ++car) {
      const std::optional<AgentTrack> track = carTrack(garage, 1.3, 120.0, random);
      if (!track) continue;
      for (std::size_t i = 0; i < track->poses.size(); i += 5) {
        const Eigen::Vector3d& pose = track->poses[i];
        for (const Stretch& stretch : stretches) {
          if (!stretch.holds(pose.head<2>(), 6.0)) continue;
          EXPECT_GT(std::cos(pose.z() - stretch.frame.heading), 0.8);
          ++places;
        }
      }
    }
  }
  EXPECT_GT(places, 1000);
}

TEST(OneWay, RoutesKeepToIt) {
  int places = 0;
  for (int seed = 5000; seed < 5008; ++seed) {
    SCOPED_TRACE(seed);
    const Garage garage = make(seed, 1.0);
    const Result<Route> route =
        planRoute(garage, "random", static_cast<std::uint64_t>(seed), VehicleShape{});
    ASSERT_TRUE(route.ok()) << route.error().message;
    const std::vector<Stretch> stretches = oneWayStretches(garage);
    for (double s = 0.0; s < route->path.length(); s += 0.5) {
      const PathPoint axle = route->path.at(s);
      for (const Stretch& stretch : stretches) {
        if (axle.direction < 0 || !stretch.holds(axle.position, 6.0)) continue;
        EXPECT_GT(std::cos(axle.heading - stretch.frame.heading), 0.8) << "after " << s << " m";
        ++places;
      }
    }
  }
  EXPECT_GT(places, 500);
}

TEST(OneWay, IsKeptInTheGaragesFile) {
  const Garage garage = make(5003, 1.0);
  ASSERT_GT(oneWayCount(garage), 0);
  const std::string path =
      (std::filesystem::temp_directory_path() / "parkade_one_way_garage.json").string();
  ASSERT_TRUE(writeGarageTruth(garage, path).ok());
  const Result<Garage> back = readGarageTruth(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(back.ok()) << back.error().message;
  ASSERT_EQ(back->aisles.edges.size(), garage.aisles.edges.size());
  for (std::size_t i = 0; i < garage.aisles.edges.size(); ++i) {
    EXPECT_EQ(back->aisles.edges[i].one_way, garage.aisles.edges[i].one_way);
    EXPECT_EQ(back->aisles.edges[i].from, garage.aisles.edges[i].from);
  }
}

TEST(OneWay, IsRefusedWhereItCannotBe) {
  GarageOptions options;
  options.one_way = 0.5;
  EXPECT_NE(generateGarage(options).error().message.find("paper"), std::string::npos);
  options.preset = "random";
  options.one_way = 1.5;
  EXPECT_NE(generateGarage(options).error().message.find("1.5"), std::string::npos);
}

}  // namespace
}  // namespace parkade::sim
