// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <set>

#include "parkade/mapping/objects/object_registry.hpp"
#include "parkade/mapping/slots/slot_registry.hpp"
#include "parkade/mapping/synthetic_plan.hpp"

namespace parkade {
namespace {

using testing::makePlan;
using testing::ObserverNoise;
using testing::Plan;
using testing::PlanObserver;
using testing::PlanSlot;

constexpr TimeNs kTick = 100'000'000;

double cornerError(const MapSlot& slot, const PlanSlot& truth) {
  return 0.5 * ((slot.corners[0] - truth.corners[0]).norm() +
                (slot.corners[1] - truth.corners[1]).norm());
}

const PlanSlot* nearestSlot(const Plan& plan, const MapSlot& slot) {
  const PlanSlot* best = nullptr;
  for (const PlanSlot& truth : plan.slots) {
    if (best == nullptr || cornerError(slot, truth) < cornerError(slot, *best)) best = &truth;
  }
  return best;
}

// Slots whose entrance a drive came near enough to see twenty times.
std::set<const PlanSlot*> passedSlots(const Plan& plan, const std::vector<SE2>& poses) {
  std::set<const PlanSlot*> passed;
  for (const PlanSlot& slot : plan.slots) {
    int near = 0;
    for (const SE2& pose : poses) {
      const Eigen::Vector2d from =
          pose.inverse() * Eigen::Vector2d(0.5 * (slot.corners[0] + slot.corners[1]));
      near += (from - Eigen::Vector2d(1.4, 0.0)).norm() < 5.5 ? 1 : 0;
    }
    if (near >= 20) passed.insert(&slot);
  }
  return passed;
}

ObserverNoise usualNoise() {
  ObserverNoise noise;
  noise.corner_sigma = 0.04;
  noise.object_sigma = 0.08;
  noise.dropout = 0.2;
  noise.attitude_sigma = 0.001;
  noise.availability_error = 0.1;
  return noise;
}

TEST(SlotRegistry, FindsEverySlotOnceWithItsNumberAndAvailability) {
  const Plan plan = makePlan(2, 60.0, 0.6, 11);
  const PlanObserver observer(plan, usualNoise());
  SlotRegistry registry({});
  ObjectRegistry objects({});
  Random random(1);
  const std::vector<SE2> poses = testing::blockDrive(60.0, 1, 0.3);
  TimeNs t_ns = 0;
  for (const SE2& pose : poses) {
    const SemanticFrame frame = observer.observe(t_ns, pose, random, false);
    // The pose is known to 3 cm and 0.2 degrees only.
    const SE2 noisy =
        pose * SE2::exp({0.03 * random.normal(), 0.03 * random.normal(), 0.0035 * random.normal()});
    registry.update(frame.slots, t_ns, noisy, 0);
    objects.update(frame.objects, noisy, 0.0, 0);
    t_ns += kTick;
  }
  const std::vector<MapSlot> slots = registry.slots(t_ns, objects.objects());
  std::set<const PlanSlot*> found;
  std::vector<double> errors;
  int availability = 0;
  int numbers = 0;
  int zones = 0;
  for (const MapSlot& slot : slots) {
    const PlanSlot* truth = nearestSlot(plan, slot);
    EXPECT_LT(cornerError(slot, *truth), 0.15) << slot.id;
    EXPECT_TRUE(found.insert(truth).second) << "slot " << truth->number << " twice";
    errors.push_back(cornerError(slot, *truth));
    availability += (slot.probability_free > 0.5) != truth->occupied ? 1 : 0;
    numbers += slot.number == truth->number ? 1 : 0;
    zones += slot.zone.empty() ? 0 : 1;
  }
  const std::set<const PlanSlot*> passed = passedSlots(plan, poses);
  for (const PlanSlot* slot : passed) EXPECT_EQ(found.count(slot), 1U) << slot->number;
  ASSERT_GT(slots.size(), 40U);
  std::sort(errors.begin(), errors.end());
  std::printf("%zu slots: corner error median %.3f m, availability right for %.3f\n", slots.size(),
              errors[errors.size() / 2], static_cast<double>(availability) / slots.size());
  EXPECT_LT(errors[errors.size() / 2], 0.03);
  EXPECT_GE(availability, 0.98 * slots.size());
  EXPECT_GE(numbers, 0.95 * slots.size());
  EXPECT_GT(zones, 0.5 * slots.size());
}

TEST(SlotRegistry, NumbersAreToldWhenSureAndOfOneSlotOnly) {
  const Plan plan = makePlan(1, 40.0, 0.5, 5);
  const PlanObserver observer(plan, {});
  SlotRegistry registry({});
  Random random(3);
  const SE2 pose(0.0, {20.0, 0.0});
  const auto look = [&](TimeNs t_ns, const std::vector<std::vector<TextReading>>& numbers) {
    std::vector<SlotObservation> slots = observer.observe(t_ns, pose, random, false).slots;
    ASSERT_GE(slots.size(), 3U);
    for (SlotObservation& slot : slots) slot.number.clear();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      slots[i].number = numbers[i];
      slots[i].number_place = 0.5 * (slots[i].corners[0] + slots[i].corners[2]);
    }
    registry.update(slots, t_ns, pose, 0);
  };
  const auto told = [&](TimeNs t_ns) {
    std::vector<std::string> texts;
    for (const MapSlot& slot : registry.slots(t_ns)) texts.push_back(slot.number);
    texts.resize(3);
    return texts;
  };
  const std::vector<TextReading> sure{{"104", 0.9}, {"04", 0.05}};
  const std::vector<TextReading> part{{"04", 0.8}, {"104", 0.05}};  // its edge was missed
  const std::vector<TextReading> faint{{"", 0.7}, {"7", 0.1}};
  for (TimeNs t = 1; t <= 3; ++t) look(t * kTick, {faint, {}, {}});
  EXPECT_THAT(told(4 * kTick), ::testing::Each(""));
  for (TimeNs t = 4; t <= 8; ++t) look(t * kTick, {faint, t % 2 == 0 ? sure : part, {}});
  EXPECT_EQ(told(9 * kTick), (std::vector<std::string>{"", "104", ""}));
  // Another slot's number misread as the same one, less often.
  for (TimeNs t = 9; t <= 11; ++t) look(t * kTick, {sure, {}, sure});
  EXPECT_EQ(told(12 * kTick), (std::vector<std::string>{"", "104", ""}));
}

TEST(SlotRegistry, AvailabilityFollowsTheWorldAndFades) {
  Plan plan = makePlan(1, 40.0, 0.0, 3);
  SlotRegistry registry({});
  Random random(2);
  const SE2 pose(0.0, {20.0, 0.0});
  TimeNs t_ns = 0;
  const auto look = [&](int times) {
    const PlanObserver observer(plan, {});
    for (int k = 0; k < times; ++k, t_ns += kTick) {
      registry.update(observer.observe(t_ns, pose, random, false).slots, t_ns, pose, 0);
    }
  };
  look(20);
  const std::size_t told = registry.slots(t_ns).size();
  ASSERT_GT(told, 3U);
  for (const MapSlot& slot : registry.slots(t_ns)) EXPECT_GT(slot.probability_free, 0.9);
  for (PlanSlot& slot : plan.slots) slot.occupied = true;
  look(20);
  for (const MapSlot& slot : registry.slots(t_ns)) EXPECT_LT(slot.probability_free, 0.1);
  EXPECT_EQ(registry.slots(t_ns).size(), told);
  const TimeNs later = t_ns + 3600LL * kNsPerSecond;
  for (const MapSlot& slot : registry.slots(later)) EXPECT_NEAR(slot.probability_free, 0.5, 0.02);
  EXPECT_EQ(registry.slots(later).size(), told);
}

TEST(SlotRegistry, WhatIsSeenAcrossNeighboursSaysLittleOnceTheEntranceWasSeenOver) {
  Plan plan = makePlan(1, 40.0, 0.0, 3);
  Random random(2);
  const SE2 pose(0.0, {20.0, 0.0});
  TimeNs t_ns = 0;
  const auto look = [&](SlotRegistry& registry, int times, bool occupied, double over_entrance) {
    for (PlanSlot& slot : plan.slots) slot.occupied = occupied;
    const PlanObserver observer(plan, {});
    for (int k = 0; k < times; ++k, t_ns += kTick) {
      std::vector<SlotObservation> slots = observer.observe(t_ns, pose, random, false).slots;
      for (SlotObservation& slot : slots) slot.seen_over_entrance = over_entrance;
      registry.update(slots, t_ns, pose, 0);
    }
  };
  SlotRegistry passed({});
  look(passed, 10, false, 1.0);
  look(passed, 20, true, 0.0);  // another car's smear
  ASSERT_GT(passed.slots(t_ns).size(), 3U);
  for (const MapSlot& slot : passed.slots(t_ns)) EXPECT_GT(slot.probability_free, 0.9);
  look(passed, 10, true, 1.0);  // and a car that came
  for (const MapSlot& slot : passed.slots(t_ns)) EXPECT_LT(slot.probability_free, 0.1);
  SlotRegistry from_aside({});
  look(from_aside, 20, true, 0.0);
  ASSERT_FALSE(from_aside.slots(t_ns).empty());
  for (const MapSlot& slot : from_aside.slots(t_ns)) EXPECT_LT(slot.probability_free, 0.1);
}

TEST(SlotRegistry, DuplicatesFromAWrongPoseMergeWhenAnchorsAreCorrected) {
  const Plan plan = makePlan(1, 40.0, 0.5, 4);
  const PlanObserver observer(plan, {});
  SlotRegistry registry({});
  Random random(3);
  const SE2 pose(0.0, {20.0, 0.0});
  const SE2 drift(0.0, {1.4, 0.3});  // more than half a slot
  for (int k = 0; k < 10; ++k) {
    registry.update(observer.observe(0, pose, random, false).slots, k * kTick, pose, 1);
  }
  const std::size_t once = registry.slots(0).size();
  const std::vector<MapSlot> before = registry.slots(0);
  for (int k = 0; k < 10; ++k) {
    registry.update(observer.observe(0, pose, random, false).slots, k * kTick, drift * pose, 2);
  }
  registry.moveWithAnchors(
      [&](std::int64_t anchor) { return anchor == 2 ? drift.inverse() : SE2(); });
  const std::vector<MapSlot> after = registry.slots(0);
  EXPECT_EQ(after.size(), once);
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    EXPECT_EQ(after[i].id, before[i].id);
  }
}

// A slot beside the car, from x = 2 m on.
SlotObservation slotTo(double x) {
  SlotObservation o;
  o.corners = {Eigen::Vector2d(2, 2), Eigen::Vector2d(x, 2), Eigen::Vector2d(x, 7),
               Eigen::Vector2d(2, 7)};
  o.entrance_covariance = 1e-3 * Eigen::Matrix4d::Identity();
  o.confidence = 0.9;
  return o;
}

TEST(SlotRegistry, FalseAlarmsAreNotTold) {
  SlotRegistry registry({});
  SlotObservation ghost = slotTo(4.5);
  ghost.confidence = 0.5;
  for (int k = 0; k < 60; ++k) {
    std::vector<SlotObservation> seen;
    if (k % 15 == 0) seen.push_back(ghost);
    registry.update(seen, k * kTick, SE2(), 0);
  }
  EXPECT_LE(registry.candidates(), 1);  // forgotten soon
  EXPECT_TRUE(registry.slots(0).empty());
}

TEST(SlotRegistry, ACarAtAStandstillMissesNothingTwice) {
  const SlotObservation seen = slotTo(4.5);
  for (const bool new_views : {false, true}) {
    SlotRegistry registry({});
    for (int k = 0; k < 5; ++k) registry.update({seen}, k * kTick, SE2(), 0);
    for (int k = 5; k < 200; ++k) registry.update({}, k * kTick, SE2(), 0, new_views);
    EXPECT_EQ(registry.slots(200 * kTick).size(), new_views ? 0U : 1U);
  }
}

TEST(SlotRegistry, OfTwoReadingsOfAPlaceTheOneSeenMoreOftenIsTold) {
  SlotRegistry registry({});
  for (int k = 0; k < 40; ++k) {
    // At first the line at its side is hidden, and a gap is taken into it.
    registry.update({slotTo(k < 8 || k % 10 == 0 ? 5.4 : 4.5)}, k * kTick, SE2(), 0);
  }
  const std::vector<MapSlot> slots = registry.slots(40 * kTick);
  ASSERT_EQ(slots.size(), 1U);
  EXPECT_NEAR(slots[0].corners[1].x(), 4.5, 0.02);
}

// A slot along the aisle y = 0, as seen from a pose.
SlotObservation besideTheAisle(const SE2& pose) {
  SlotObservation o;
  o.corners = {Eigen::Vector2d(2, 2), Eigen::Vector2d(4.5, 2), Eigen::Vector2d(4.5, 7),
               Eigen::Vector2d(2, 7)};
  o.entrance_covariance = 1e-3 * Eigen::Matrix4d::Identity();
  o.confidence = 0.9;
  for (Eigen::Vector2d& p : o.corners) p = pose.inverse() * p;
  return o;
}

TEST(SlotRegistry, WhereTheCarDroveUnheardNobodyKnows) {
  // Along the aisle, then around a corner without a picture for so many metres' chord.
  const auto told = [&](const std::vector<SE2>& way) {
    SlotRegistry registry({});
    TimeNs t_ns = 0;
    for (const SE2& pose : way) {
      registry.update({besideTheAisle(pose)}, t_ns += kTick, pose, 0);
    }
    return registry.slots(t_ns).size();
  };
  std::vector<SE2> aisle;
  for (int k = 0; k <= 20; ++k) aisle.emplace_back(0.0, Eigen::Vector2d(-3.0 + 0.2 * k, 0.0));
  EXPECT_EQ(told(aisle), 1U);
  std::vector<SE2> gap = aisle;
  gap.emplace_back(M_PI_2, Eigen::Vector2d(7.0, 9.0));  // the chord crosses the slot
  EXPECT_EQ(told(gap), 1U);
  std::vector<SE2> through = aisle;
  for (int k = 1; k <= 40; ++k) {
    through.emplace_back(0.98, Eigen::Vector2d(1.0 + 6.0 * k / 40, 9.0 * k / 40));
  }
  EXPECT_EQ(told(through), 0U);
}

TEST(SlotRegistry, NoSlotWhereTheCarDroveThroughOrDriversMarksLie) {
  const auto told = [&](const SE2& from, const SE2& to, const std::vector<MapObject>& objects) {
    SlotRegistry registry({});
    for (int k = 0; k <= 40; ++k) {
      const SE2 pose(from.angle(),
                     from.translation() + k / 40.0 * (to.translation() - from.translation()));
      registry.update({besideTheAisle(pose)}, k * kTick, pose, 0);
    }
    return registry.slots(0, objects).size();
  };
  const SE2 aisle_from(0.0, {-2.0, 0.0});
  const SE2 aisle_to(0.0, {8.0, 0.0});
  EXPECT_EQ(told(aisle_from, aisle_to, {}), 1U);
  EXPECT_EQ(told(SE2(M_PI_2, {3.25, 0.0}), SE2(M_PI_2, {3.25, 4.0}), {}), 1U);  // parks in it
  EXPECT_EQ(told(SE2(0.0, {-2.0, 4.0}), SE2(0.0, {8.0, 4.0}), {}), 0U);         // across
  EXPECT_EQ(told(SE2(M_PI_2, {3.25, 0.0}), SE2(M_PI_2, {3.25, 9.0}), {}), 0U);  // out of its rear
  MapObject arrow;
  arrow.semantic_class = SemanticClass::kArrow;
  arrow.position = {3.0, 4.0, 0.0};
  EXPECT_EQ(told(aisle_from, aisle_to, {arrow}), 0U);
  arrow.position.y() = 1.0;
  EXPECT_EQ(told(aisle_from, aisle_to, {arrow}), 1U);
  arrow.position.y() = 4.0;
  arrow.semantic_class = SemanticClass::kPaintedNumber;
  EXPECT_EQ(told(aisle_from, aisle_to, {arrow}), 1U);
}

TEST(ObjectRegistry, FindsArrowsPillarsAndMarkersOnce) {
  const Plan plan = makePlan(2, 60.0, 0.6, 11);
  ObserverNoise noise = usualNoise();
  const PlanObserver observer(plan, noise);
  ObjectRegistry registry({});
  Random random(5);
  for (const SE2& pose : testing::blockDrive(60.0, 1, 0.3)) {
    registry.update(observer.observe(0, pose, random, false).objects, pose, 0.0, 0);
  }
  const std::vector<MapObject> objects = registry.objects();
  std::set<const testing::PlanObject*> found;
  for (const MapObject& object : objects) {
    const testing::PlanObject* best = nullptr;
    double distance = 0.3;
    for (const testing::PlanObject& truth : plan.objects) {
      if (truth.semantic_class != object.semantic_class) continue;
      const double d = (truth.position - object.position).norm();
      if (d >= distance) continue;
      distance = d;
      best = &truth;
    }
    ASSERT_NE(best, nullptr);
    EXPECT_EQ(object.text, best->text);
    EXPECT_TRUE(found.insert(best).second);
    EXPECT_LT(distance, 0.1);
    if (object.semantic_class == SemanticClass::kArrow) {
      EXPECT_LT(std::abs(wrapAngle(object.heading - best->heading)), 0.05);
    }
  }
  EXPECT_GT(objects.size(), 20U);
}

TEST(ObjectRegistry, ManyLooksKnowAPlaceNoBetterThanWhatTheyShare) {
  ObjectObservation arrow;
  arrow.semantic_class = SemanticClass::kArrow;
  arrow.position = {4.0, 0.0, 0.0};
  arrow.covariance = 4e-4 * Eigen::Matrix3d::Identity();
  arrow.confidence = 0.9;
  ObjectRegistry registry({});
  for (int k = 0; k < 50; ++k) registry.update({arrow}, SE2(), 0.0, 0);
  const std::vector<MapObject> objects = registry.objects();
  ASSERT_EQ(objects.size(), 1U);
  const double floor = ObjectRegistryOptions().position_floor_m;
  EXPECT_GE(objects[0].position_sigma, floor);
  EXPECT_LT(objects[0].position_sigma, 1.1 * floor);
}

}  // namespace
}  // namespace parkade
