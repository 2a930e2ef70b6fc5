// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/map_landmarks.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/synthetic_plan.hpp"

namespace parkade {
namespace {

using testing::makePlan;
using testing::Plan;

double distanceToLines(const Plan& plan, const Eigen::Vector2d& p) {
  double least = 1e9;
  for (const testing::PlanLine& line : plan.lines) {
    least = std::min(least, distanceToSegment(p, line.a, line.b));
  }
  return least;
}

TEST(MapLandmarks, LiePreciselyOnTheLinesOfAnyDirection) {
  const Plan plan = makePlan(1, 40.0, 0.3, 4);
  for (const double turn : {0.0, 0.4, 1.0}) {
    const SE2 T_map_plan(turn, {3.0, -2.0});
    const Submap landmarks = landmarksOf(testing::mapOf(plan, T_map_plan));
    ASSERT_GT(landmarks.lines().features().size(), 500U);
    double squares = 0.0;
    for (const LineFeature& line : landmarks.lines().features()) {
      const double off = distanceToLines(plan, T_map_plan.inverse() * line.p);
      EXPECT_LT(off, 0.06);  // half of a line, where two meet
      squares += off * off;
      const Eigen::Vector2d normal = T_map_plan.inverse().rotationMatrix() * line.normal;
      EXPECT_GT(normal.cwiseAbs().maxCoeff(), 0.97);  // 14 degrees, where a line ends
    }
    const auto count = static_cast<double>(landmarks.lines().features().size());
    EXPECT_LT(std::sqrt(squares / count), 0.015);
  }
}

TEST(MapLandmarks, HoldCornersAndMarkersWithTheirTexts) {
  const Plan plan = makePlan(1, 40.0, 0.3, 4);
  const Submap landmarks = landmarksOf(testing::mapOf(plan));
  for (const testing::PlanSlot& slot : plan.slots) {
    EXPECT_NE(landmarks.nearestPoint(slot.corners[0], SemanticClass::kSlotLine, "", 0.05), nullptr);
  }
  int markers = 0;
  for (const testing::PlanObject& object : plan.objects) {
    if (object.semantic_class != SemanticClass::kZoneMarker) continue;
    ++markers;
    const Eigen::Vector2d p = object.position.head<2>();
    EXPECT_NE(landmarks.nearestPoint(p, object.semantic_class, object.text, 0.05), nullptr);
    EXPECT_EQ(landmarks.nearestPoint(p, object.semantic_class, "other", 0.05), nullptr);
  }
  EXPECT_GT(markers, 3);
}

TEST(MapLandmarks, AnEmptyMapHasNone) {
  const Submap landmarks = landmarksOf(ParkingMap());
  EXPECT_TRUE(landmarks.lines().features().empty());
  EXPECT_TRUE(landmarks.points().empty());
}

}  // namespace
}  // namespace parkade
