// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/map_search.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "parkade/mapping/synthetic_plan.hpp"

namespace parkade {
namespace {

using testing::makePlan;
using testing::Plan;
using testing::PlanObserver;
using testing::usualNoise;

void addOnce(const SE2& place, std::vector<SE2>& places) {
  const bool known = std::any_of(places.begin(), places.end(),
                                 [&](const SE2& other) { return samePlace(place, other, 0.5); });
  if (!known) places.push_back(place);
}

// What a drive of some metres up to a pose shows, as a mapper would gather it.
Surroundings gather(const Plan& plan, const SE2& at, double way, Random& random) {
  const PlanObserver observer(plan, usualNoise());
  Surroundings result;
  Submap all;
  for (double back = way; back >= 0.0; back -= 1.0) {
    const SE2 here(0.0, {-back, 0.0});
    const SemanticFrame frame = observer.observe(0, at * here, random, false);
    all.add(frame, here);
    for (const SlotObservation& slot : frame.slots) {
      addOnce(here * slotFrame(slot.corners), result.slots);
    }
    for (const ObjectObservation& object : frame.objects) {
      if (object.semantic_class != SemanticClass::kArrow) continue;
      addOnce(here * SE2(object.heading, object.position.head<2>()), result.arrows);
    }
  }
  result.features = asFrame(all);
  return result;
}

TEST(MapSearch, SlotFrameLooksIntoTheSlot) {
  // Entered northwards, as seen by who drives in.
  const std::array<Eigen::Vector2d, 4> corners = {
      Eigen::Vector2d{0.0, 0.0}, {2.5, 0.0}, {2.5, 5.0}, {0.0, 5.0}};
  const SE2 T = slotFrame(corners);
  EXPECT_NEAR(T.angle(), M_PI_2, 1e-12);
  EXPECT_NEAR(T.translation().x(), 1.25, 1e-12);
}

TEST(MapSearch, FindsTheCarInAGarageOfLookAlikesWithoutAnyIdea) {
  Random random(3);
  int found = 0;
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    const Plan plan = makePlan(2, 80.0, 0.4, 20 + static_cast<std::uint64_t>(round));
    const SE2 T_map_plan(random.uniform(-M_PI, M_PI), {5.0, -30.0});
    const SavedMap map(testing::mapOf(plan, T_map_plan));
    const SE2 truth(round % 2 == 0 ? 0.0 : M_PI,
                    {random.uniform(30.0, 50.0), round % 3 == 0 ? 16.0 : 0.0});
    const LoopResult r = findInMap(gather(plan, truth, 15.0, random), map, {}, {});
    if (!r.accepted) {
      std::printf("round %d: %s\n", round, r.reason.c_str());
      continue;
    }
    ++found;
    const SE2 off = r.registration.T_map_vehicle.inverse() * T_map_plan * truth;
    EXPECT_LT(off.translation().norm(), 0.06) << "round " << round << ": a false place";
    EXPECT_LT(std::abs(off.angle()), 0.01);
  }
  std::printf("found in %d of %d rounds\n", found, kRounds);
  EXPECT_GE(found, kRounds - 1);
}

TEST(MapSearch, ARowWithoutAnythingOfItsOwnAndAnotherGarageAreRefused) {
  Random random(4);
  Plan plain = makePlan(1, 80.0, 0.0, 3);
  plain.objects.clear();  // nothing but slots, each like the next
  const SE2 truth(0.0, {40.0, 0.0});
  const SavedMap row(testing::mapOf(plain));
  const LoopResult ambiguous = findInMap(gather(plain, truth, 10.0, random), row, {}, {});
  EXPECT_FALSE(ambiguous.accepted);
  EXPECT_THAT(ambiguous.reason, ::testing::HasSubstr("another place"));
  // Other arrows and texts, the same rows of slots.
  Plan other = makePlan(2, 80.0, 0.4, 77);
  for (testing::PlanObject& object : other.objects) {
    if (object.semantic_class == SemanticClass::kZoneMarker) object.text = "Z" + object.text;
  }
  const SavedMap map(testing::mapOf(makePlan(2, 80.0, 0.4, 20)));
  EXPECT_FALSE(findInMap(gather(other, truth, 15.0, random), map, {}, {}).accepted);
}

TEST(MapSearch, HeightIsThatOfTheNearestWay) {
  ParkingMap map;
  EXPECT_EQ(SavedMap(map).heightAt({0.0, 0.0}), 0.0);
  map.nodes = {{1, 0, SE3(SO3(), {0.0, 0.0, 0.1})}, {2, 0, SE3(SO3(), {10.0, 0.0, -0.4})}};
  EXPECT_EQ(SavedMap(map).heightAt({8.0, 3.0}), -0.4);
}

TEST(MapSearch, SaysWhenThereIsNothingToGoBy) {
  const SavedMap map(testing::mapOf(makePlan(1, 40.0, 0.3, 4)));
  const LoopResult r = findInMap({}, map, {}, {});
  EXPECT_FALSE(r.accepted);
  EXPECT_EQ(r.reason, "no slot or arrow is seen yet");
}

}  // namespace
}  // namespace parkade
