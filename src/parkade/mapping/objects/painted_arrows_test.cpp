// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/painted_arrows.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <string>

#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

// An arrow of 3 m about the middle of its length; x ahead, y left.
bool isArrow(const std::string& meaning, const Vector2d& p) {
  const double y = std::abs(p.y());
  if (meaning == "straight") {
    return (p.x() > -1.5 && p.x() < 0.6 && y < 0.1) ||
           (p.x() >= 0.6 && p.x() < 1.5 && y < 0.35 * (1.5 - p.x()) / 0.9);
  }
  const double side = meaning == "left" ? p.y() : -p.y();
  return (p.x() > -1.5 && p.x() < 1.0 && y < 0.1) ||
         (std::abs(p.x() - 1.0) < 0.1 && side > 0.0 && side < 0.5) ||
         (side >= 0.5 && side < 1.2 && std::abs(p.x() - 1.0) < 0.5 * (1.2 - side));
}

// A floor of 30 x 20 m with a row of slots, which tells the axes, and arrows painted on it.
class PaintedArrows : public ::testing::Test {
 protected:
  PaintedArrows() {
    for (int x = 0; x < 600; ++x) {
      for (int y = 0; y < 400; ++y) {
        map.grid.set(GridLayer::kRoadMarkers, {x, y}, SemanticClass::kFloor, 1.0F);
      }
    }
    for (int place = 0; place < 6; ++place) {
      MapSlot slot = testing::Garage::slotAt(0, place);
      slot.id = place + 1;
      for (Vector2d& corner : slot.corners) corner.y() += 21.0;
      map.slots.push_back(slot);
    }
  }

  // Paints an arrow where the shape is not worn; only what was seen of it is known.
  void paint(const std::string& meaning, const SE2& place,
             const std::function<bool(const Vector2d&)>& worn = {},
             const std::function<bool(const Vector2d&)>& hidden = {}) {
    map.grid.forEachKnown(GridLayer::kRoadMarkers, [&](const Vector2i& cell, const GridCell&) {
      const Vector2d p = place.inverse() * map.grid.centerOf(cell);
      if (p.norm() > 2.5) return;
      if (hidden && hidden(p)) {
        map.grid.forget(GridLayer::kRoadMarkers, {cell});
      } else if (isArrow(meaning, p) && !(worn && worn(p))) {
        map.grid.set(GridLayer::kRoadMarkers, cell, SemanticClass::kArrow, 2.0F);
      }
    });
  }
  void tell(const std::string& meaning, const SE2& place) {
    MapObject object;
    object.id = static_cast<std::int64_t>(map.objects.size()) + 7;
    object.semantic_class = SemanticClass::kArrow;
    object.position << place.translation(), 0.0;
    object.heading = place.angle();
    object.text = meaning;
    object.observations = 12;
    const double side = meaning == "straight" ? 0.35 : 1.2;
    for (const Vector2d& p :
         {Vector2d(-1.5, -side), Vector2d(1.5, -side), Vector2d(1.5, side), Vector2d(-1.5, side)}) {
      object.outline.push_back(place * p);
    }
    map.objects.push_back(object);
  }
  void tellThree() {
    for (const auto& [meaning, x] :
         {std::pair{"straight", 3.0}, {"straight", 9.0}, {"left", 15.0}}) {
      const SE2 place(0.0, {x, 3.0});
      paint(meaning, place);
      tell(meaning, SE2(0.01, {x + 0.03, 2.98}));
    }
  }
  [[nodiscard]] SemanticClass at(const Vector2d& p) const {
    return map.grid.at(GridLayer::kRoadMarkers, map.grid.cellOf(p)).believed();
  }

  ParkingMap map;
};

TEST_F(PaintedArrows, OneThatIsHalfWornIsToldAndDrawnWhole) {
  tellThree();
  const SE2 place(M_PI_2, {20.0, 12.0});
  paint("straight", place, [](const Vector2d& p) { return p.x() > -0.9 && p.x() < 0.3; });
  ASSERT_EQ(at({20.0, 12.0}), SemanticClass::kFloor);

  completeArrows(map);

  ASSERT_EQ(map.objects.size(), 4U);
  const MapObject& found = map.objects.back();
  EXPECT_NEAR(found.position.x(), 20.0, 0.06);
  EXPECT_NEAR(found.position.y(), 12.0, 0.06);
  EXPECT_NEAR(found.heading, M_PI_2, 0.02);
  EXPECT_EQ(found.text, "straight");
  EXPECT_EQ(found.id, 10);
  EXPECT_EQ(found.observations, 0);
  EXPECT_EQ(at({20.0, 12.0}), SemanticClass::kArrow);
  EXPECT_EQ(at({20.5, 12.0}), SemanticClass::kFloor);
}

TEST_F(PaintedArrows, OneOfAnotherWayIsNotTakenForIt) {
  tellThree();
  // Only "left" was told; "right" is its mirror image, and no kind that was told fits this one.
  paint("right", SE2(0.0, {20.0, 12.0}));
  const std::size_t told = map.objects.size();
  completeArrows(map);
  EXPECT_EQ(map.objects.size(), told);
}

TEST_F(PaintedArrows, OneHiddenInPartIsToldWithoutFillingWhatNobodySaw) {
  tellThree();
  paint("left", SE2(M_PI, {20.0, 12.0}), {}, [](const Vector2d& p) { return p.x() < -0.8; });
  completeArrows(map);
  ASSERT_EQ(map.objects.size(), 4U);
  EXPECT_EQ(map.objects.back().text, "left");
  EXPECT_NEAR(std::abs(map.objects.back().heading), M_PI, 0.02);
  EXPECT_EQ(at({21.2, 12.0}), SemanticClass::kUnknown);
}

TEST_F(PaintedArrows, ABarIsNone) {
  tellThree();
  for (int x = 380; x < 420; ++x) {
    for (int y = 238; y < 242; ++y) {
      map.grid.set(GridLayer::kRoadMarkers, {x, y}, SemanticClass::kArrow, 2.0F);
    }
  }
  completeArrows(map);
  EXPECT_EQ(map.objects.size(), 3U);
}

TEST_F(PaintedArrows, NoneIsToldInASlotOrWithoutOneToLearnFrom) {
  paint("straight", SE2(0.0, {20.0, 12.0}));
  completeArrows(map);
  EXPECT_TRUE(map.objects.empty());

  tellThree();
  for (Vector2d& corner : map.slots[2].corners) corner -= Vector2d(-13.0, 11.5);
  completeArrows(map);
  EXPECT_EQ(map.objects.size(), 3U);
}

TEST_F(PaintedArrows, TheMapOfADriveThatWentAstrayStaysAsItIs) {
  tellThree();
  paint("straight", SE2(M_PI_2, {20.0, 12.0}));
  map.grid.set(GridLayer::kRoadMarkers, {20000000, 20000000}, SemanticClass::kFloor, 1.0F);
  completeArrows(map);
  EXPECT_EQ(map.objects.size(), 3U);
}

TEST_F(PaintedArrows, WornPiecesOfTheToldAreDrawn) {
  const auto worn = [](const Vector2d& p) { return std::abs(p.x() + 0.5) < 0.3; };
  paint("straight", SE2(0.0, {3.0, 3.0}));
  paint("straight", SE2(0.0, {9.0, 3.0}));
  paint("straight", SE2(0.0, {15.0, 3.0}), worn);
  for (const double x : {3.0, 9.0, 15.0}) tell("straight", SE2(0.0, {x, 3.0}));
  ASSERT_EQ(at({14.5, 3.0}), SemanticClass::kFloor);
  completeArrows(map);
  EXPECT_EQ(map.objects.size(), 3U);
  EXPECT_EQ(at({14.5, 3.0}), SemanticClass::kArrow);
  EXPECT_EQ(at({14.5, 3.2}), SemanticClass::kFloor);
}

}  // namespace
}  // namespace parkade
