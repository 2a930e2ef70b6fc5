// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <set>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/object_registry.hpp"
#include "parkade/mapping/slot_registry.hpp"
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
  for (const MapSlot& slot : registry.slots(t_ns)) EXPECT_GT(slot.probability_free, 0.9);
  for (PlanSlot& slot : plan.slots) slot.occupied = true;
  look(20);
  for (const MapSlot& slot : registry.slots(t_ns)) EXPECT_LT(slot.probability_free, 0.1);
  const TimeNs later = t_ns + 3600LL * kNsPerSecond;
  for (const MapSlot& slot : registry.slots(later)) EXPECT_NEAR(slot.probability_free, 0.5, 0.02);
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

TEST(SlotRegistry, FalseAlarmsAreNotTold) {
  SlotRegistry registry({});
  SlotObservation ghost;
  ghost.corners = {Eigen::Vector2d(2, 2), Eigen::Vector2d(4.5, 2), Eigen::Vector2d(4.5, 7),
                   Eigen::Vector2d(2, 7)};
  ghost.entrance_covariance = 1e-3 * Eigen::Matrix4d::Identity();
  ghost.confidence = 0.5;
  for (int k = 0; k < 60; ++k) {
    std::vector<SlotObservation> seen;
    if (k % 15 == 0) seen.push_back(ghost);
    registry.update(seen, k * kTick, SE2(), 0);
  }
  EXPECT_EQ(registry.candidates(), 1);
  EXPECT_TRUE(registry.slots(0).empty());
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

TEST(Votes, GateIsTheChiSquareOfFourDegrees) {
  EXPECT_NEAR(chiSquareGate4(0.95), 9.488, 1e-3);
  EXPECT_NEAR(chiSquareGate4(0.999), 18.467, 1e-3);
}

}  // namespace
}  // namespace parkade
