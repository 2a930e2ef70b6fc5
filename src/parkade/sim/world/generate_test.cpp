// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/generate.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <queue>
#include <set>
#include <string>

#include "parkade/sim/world/polygon.hpp"
#include "parkade/sim/world/structure.hpp"
#include "parkade/sim/world/style.hpp"

namespace parkade::sim {
namespace {

Garage make(const std::string& preset, int seed, double occupancy = 0.6) {
  GarageOptions options;
  options.preset = preset;
  options.seed = seed;
  options.occupancy = occupancy;
  return generateGarage(options).value();
}

Polygon outlineOf(const Slot& slot) {
  return {slot.corners.begin(), slot.corners.end()};
}

Polygon box(const Eigen::Vector2d& min, const Eigen::Vector2d& max) {
  return rectangle({}, min.x(), min.y(), max.x(), max.y());
}

/// Slots lie inside, touch no pillar, room, aisle or other slot, and carry unique numbers.
void expectValid(const Garage& garage) {
  ASSERT_GT(garage.slots.size(), 10U);
  std::set<std::string> numbers;
  for (std::size_t i = 0; i < garage.slots.size(); ++i) {
    const Slot& slot = garage.slots[i];
    const Polygon polygon = outlineOf(slot);
    EXPECT_GT(signedArea(polygon), 8.0);
    EXPECT_TRUE(numbers.insert(slot.number).second) << slot.number;
    for (const Eigen::Vector2d& p : polygon) {
      EXPECT_TRUE(contains(garage.outline, p)) << slot.id;
    }
    for (std::size_t j = i + 1; j < garage.slots.size(); ++j) {
      EXPECT_FALSE(convexOverlap(polygon, outlineOf(garage.slots[j]), 1e-3)) << i << " " << j;
    }
    for (const Pillar& pillar : garage.pillars) {
      EXPECT_FALSE(convexOverlap(
          polygon, box(pillar.center - 0.5 * pillar.size, pillar.center + 0.5 * pillar.size), 1e-3))
          << "slot " << slot.id << " pillar " << pillar.id;
    }
    for (const Room& room : garage.rooms) {
      EXPECT_FALSE(convexOverlap(polygon, box(room.min, room.max), 1e-3)) << slot.id;
    }
  }
}

/// Aisles are free of slots, pillars and rooms, and every node is reached.
void expectDrivable(const Garage& garage) {
  const AisleGraph& graph = garage.aisles;
  ASSERT_GE(graph.nodes.size(), 4U);
  std::vector<std::vector<int>> next(graph.nodes.size());
  for (const AisleGraph::Edge& edge : graph.edges) {
    const Polygon lane = strip(graph.nodes[static_cast<std::size_t>(edge.from)],
                               graph.nodes[static_cast<std::size_t>(edge.to)], edge.width);
    for (const Slot& slot : garage.slots) {
      EXPECT_FALSE(convexOverlap(lane, outlineOf(slot), 1e-3)) << slot.id;
    }
    for (const Pillar& pillar : garage.pillars) {
      EXPECT_FALSE(convexOverlap(
          lane, box(pillar.center - 0.5 * pillar.size, pillar.center + 0.5 * pillar.size), 1e-3));
    }
    for (const Room& room : garage.rooms) {
      EXPECT_FALSE(convexOverlap(lane, box(room.min, room.max), 1e-3));
    }
    next[static_cast<std::size_t>(edge.from)].push_back(edge.to);
    next[static_cast<std::size_t>(edge.to)].push_back(edge.from);
  }
  std::set<int> seen = {0};
  std::queue<int> todo({0});
  while (!todo.empty()) {
    for (const int node : next[static_cast<std::size_t>(todo.front())]) {
      if (seen.insert(node).second) todo.push(node);
    }
    todo.pop();
  }
  EXPECT_EQ(seen.size(), graph.nodes.size());
}

TEST(GenerateTest, PaperGarageHasTheSizeAndSlotsOfTheTable) {
  const Garage garage = make("paper", 0);
  EXPECT_EQ(garage.slots.size(), 157U);
  EXPECT_NEAR(garage.area(), 9000.0, 180.0);
  int types[3] = {0, 0, 0};
  for (const Slot& slot : garage.slots) ++types[static_cast<int>(slot.type)];
  EXPECT_GT(types[0], 100);
  EXPECT_GE(types[1], 5);
  EXPECT_GE(types[2], 10);
  expectValid(garage);
  expectDrivable(garage);
}

TEST(GenerateTest, RandomGaragesAreValid) {
  for (int seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    const Garage garage = make("random", seed);
    EXPECT_GT(garage.area(), 1500.0);
    EXPECT_LT(garage.area(), 12000.0);
    expectValid(garage);
    expectDrivable(garage);
  }
}

TEST(GenerateTest, PaintShowsOnEveryFloor) {
  const Eigen::Vector3f luminance(0.2126F, 0.7152F, 0.0722F);
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const GarageStyle style = makeStyle("random", seed);
    for (const Eigen::Vector3f& floor : {style.slot_floor, style.aisle_floor}) {
      for (const Eigen::Vector3f& paint : {style.line_colour, style.arrow_colour}) {
        EXPECT_GE(paint.dot(luminance), 1.69F * floor.dot(luminance)) << "seed " << seed;
      }
    }
  }
}

TEST(GenerateTest, ZoneTextsFitOnTheirPillars) {
  int round = 0;
  for (int seed = 0; seed < 50; ++seed) {
    const Garage garage = make("random", seed);
    for (const Sign& sign : garage.signs) {
      if (sign.semantic_class != SemanticClass::kZoneMarker) continue;
      const auto pillar = std::find_if(garage.pillars.begin(), garage.pillars.end(),
                                       [&](const Pillar& p) { return p.zone_text == sign.text; });
      ASSERT_NE(pillar, garage.pillars.end());
      EXPECT_LE(sign.width - 0.06, 0.87 * zonePlateWidth(*pillar)) << sign.text;
      round += pillar->round ? 1 : 0;
    }
  }
  EXPECT_GT(round, 100);
}

TEST(GenerateTest, MarkingsLieInsideAndSignsAreUnique) {
  for (int seed = -1; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    const Garage garage = seed < 0 ? make("paper", 0) : make("random", seed);
    std::set<int> ids;
    for (const Marking& marking : garage.markings) {
      EXPECT_TRUE(ids.insert(marking.id).second);
      EXPECT_FALSE(marking.polygons.empty());
      for (const Polygon& polygon : marking.polygons) {
        EXPECT_GT(signedArea(polygon), 0.0) << marking.id << " " << marking.meaning;
        for (const Eigen::Vector2d& p : polygon) {
          EXPECT_TRUE(contains(garage.outline, p)) << marking.id << " " << marking.meaning;
        }
      }
    }
    std::set<std::string> zones;
    for (const Pillar& pillar : garage.pillars) {
      if (pillar.zone_text.empty()) continue;
      EXPECT_TRUE(zones.insert(pillar.zone_text).second) << pillar.zone_text;
    }
    for (const Sign& sign : garage.signs) {
      if (sign.semantic_class == SemanticClass::kZoneMarker) {
        EXPECT_EQ(zones.count(sign.text), 1U) << sign.text;
        EXPECT_GT(sign.height, 0.15);
        EXPECT_LE(sign.width, 0.95);
      }
      EXPECT_NEAR(sign.T_world_sign.rotation().matrix()(2, 1), 1.0, 1e-9);  // y is up
    }
    for (const Slot& slot : garage.slots) EXPECT_EQ(zones.count(slot.zone), 1U) << slot.id;
  }
}

TEST(GenerateTest, ZonesBeginAtAnyLetterAndNothingElseChanges) {
  const Garage usual = make("random", 12);
  GarageOptions options;
  options.preset = "random";
  options.seed = 12;
  options.first_zone = "Y";
  const Result<Garage> garage = generateGarage(options);
  ASSERT_TRUE(garage.ok()) << garage.error().message;
  ASSERT_EQ(garage->pillars.size(), usual.pillars.size());
  std::set<char> letters;
  for (std::size_t i = 0; i < usual.pillars.size(); ++i) {
    const std::string& text = garage->pillars[i].zone_text;
    ASSERT_EQ(text.size(), usual.pillars[i].zone_text.size());
    for (std::size_t k = 0; k < text.size(); ++k) {
      const char before = usual.pillars[i].zone_text[k];
      if (std::isalpha(static_cast<unsigned char>(before)) == 0) {
        EXPECT_EQ(text[k], before);
      } else {
        letters.insert(text[k]);
        const std::size_t row = kZoneLetters.find(before);
        EXPECT_EQ(text[k], kZoneLetters[(row + kZoneLetters.find('Y')) % kZoneLetters.size()]);
      }
    }
  }
  EXPECT_EQ(letters.count('Y'), 1U);
  EXPECT_EQ(garage->markings.size(), usual.markings.size());

  for (const char* wrong : {"", "I", "a", "AB"}) {
    options.first_zone = wrong;
    const Result<Garage> refused = generateGarage(options);
    ASSERT_FALSE(refused.ok()) << wrong;
    EXPECT_THAT(refused.error().message, ::testing::HasSubstr("first_zone"));
  }
}

TEST(GenerateTest, PaperGarageHasEveryKindOfMarkingAndSign) {
  const Garage garage = make("paper", 0);
  std::set<SemanticClass> seen;
  for (const Marking& marking : garage.markings) seen.insert(marking.semantic_class);
  for (const Sign& sign : garage.signs) seen.insert(sign.semantic_class);
  for (const SemanticClass expected :
       {SemanticClass::kSlotLine, SemanticClass::kLaneLine, SemanticClass::kArrow,
        SemanticClass::kSpeedLimitPaint, SemanticClass::kStopLine, SemanticClass::kCrossing,
        SemanticClass::kSpeedBump, SemanticClass::kPaintedNumber, SemanticClass::kWheelStop,
        SemanticClass::kZoneMarker, SemanticClass::kGuideSign, SemanticClass::kSpeedLimitSign}) {
    EXPECT_EQ(seen.count(expected), 1U) << static_cast<int>(expected);
  }
  std::set<SlotMarking> markings;
  for (const Slot& slot : garage.slots) markings.insert(slot.marking);
  EXPECT_EQ(markings.size(), 4U);
}

TEST(GenerateTest, OccupancyIsExactToTheSlot) {
  for (const double share : {0.0, 0.2, 0.6, 0.95, 1.0}) {
    const Garage garage = make("paper", 3, share);
    int occupied = 0;
    for (const Slot& slot : garage.slots) occupied += slot.occupied ? 1 : 0;
    EXPECT_EQ(occupied, std::lround(share * 157));
  }
}

std::vector<bool> occupiedOf(const Garage& garage) {
  std::vector<bool> occupied;
  for (const Slot& slot : garage.slots) occupied.push_back(slot.occupied);
  return occupied;
}

TEST(GenerateTest, AnotherParkedSeedParksOtherCarsInTheSameGarage) {
  const Garage usual = make("random", 12);
  GarageOptions options;
  options.preset = "random";
  options.seed = 12;
  options.parked_seed = 12;
  EXPECT_EQ(occupiedOf(generateGarage(options).value()), occupiedOf(usual));
  options.parked_seed = 13;
  const Garage later = generateGarage(options).value();
  const std::vector<bool> before = occupiedOf(usual);
  const std::vector<bool> after = occupiedOf(later);
  EXPECT_NE(after, before);
  EXPECT_EQ(std::count(after.begin(), after.end(), true),
            std::count(before.begin(), before.end(), true));
  ASSERT_EQ(later.slots.size(), usual.slots.size());
  for (std::size_t i = 0; i < usual.slots.size(); ++i) {
    EXPECT_EQ(outlineOf(later.slots[i]), outlineOf(usual.slots[i]));
  }
  ASSERT_EQ(later.markings.size(), usual.markings.size());
  for (std::size_t i = 0; i < usual.markings.size(); ++i) {
    EXPECT_EQ(later.markings[i].polygons, usual.markings[i].polygons);
  }
  EXPECT_EQ(later.pillars.size(), usual.pillars.size());
  EXPECT_EQ(later.signs.size(), usual.signs.size());
  EXPECT_EQ(later.aisles.nodes, usual.aisles.nodes);
}

TEST(GenerateTest, RefusesWhatItDoesNotKnow) {
  GarageOptions options;
  options.preset = "castle";
  EXPECT_NE(generateGarage(options).error().message.find("castle"), std::string::npos);
  options = {};
  options.occupancy = 1.5;
  EXPECT_NE(generateGarage(options).error().message.find("1.5"), std::string::npos);
}

TEST(GarageTest, RampsAndBumpsAreSmooth) {
  Garage garage;
  garage.ramps.push_back({{1.0, 0.0}, Eigen::Vector2d::UnitX(), 10.0, 0.3});
  garage.bumps.push_back({{20.0, 0.0}, 0.0, 0.35, 5.0, 0.04});
  EXPECT_DOUBLE_EQ(garage.floorHeight({0.0, 3.0}), 0.0);
  EXPECT_NEAR(garage.floorHeight({6.0, 3.0}), 0.15, 1e-12);
  EXPECT_DOUBLE_EQ(garage.floorHeight({12.0, 3.0}), 0.3);
  EXPECT_NEAR(garage.surfaceHeight({20.0, 0.0}), 0.34, 1e-12);
  EXPECT_NEAR(garage.surfaceHeight({20.1751, 0.0}), 0.3, 1e-12);
  constexpr double kStep = 1e-3;
  for (double x = 0.5; x < 11.5; x += 0.05) {
    const auto height = [&](double at) { return garage.floorHeight({at, 0.0}); };
    const double slope = (height(x + kStep) - height(x - kStep)) / (2.0 * kStep);
    EXPECT_LE(std::abs(slope), 2.0 * 0.3 / 10.0 + 1e-9);
  }
}

}  // namespace
}  // namespace parkade::sim
