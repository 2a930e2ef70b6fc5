// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/agent_tracker.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

AgentDetection person(const Eigen::Vector2d& p) {
  AgentDetection d;
  d.semantic_class = SemanticClass::kPedestrian;
  d.contact = p;
  d.covariance = 0.12 * 0.12 * Eigen::Matrix2d::Identity();
  d.box.center = p;
  d.box.size = {0.5, 0.5};
  d.confidence = 0.9;
  return d;
}

// The faces of a car that the own car's middle sees.
AgentDetection car(const GroundBox& box) {
  AgentDetection d;
  d.box = box;
  d.contact = box.nearestTo(Eigen::Vector2d::Zero());
  d.covariance = 0.1 * 0.1 * Eigen::Matrix2d::Identity();
  d.confidence = 0.9;
  return d;
}

constexpr TimeNs kStep = 200 * kNsPerSecond / 1000;

TEST(AgentTracker, FollowsPeopleThatCrossWhileTheCarTurns) {
  AgentTracker tracker({});
  Random random(5);
  std::set<std::uint64_t> first;
  std::set<std::uint64_t> second;
  int told = 0;
  for (int k = 0; k < 30; ++k) {
    const double t = 0.2 * k;
    const SE2 pose(0.1 * t, {0.8 * t, 0.05 * t});
    const Eigen::Vector2d a(6.0, -3.0 + 1.2 * t);
    const Eigen::Vector2d b(7.0, 3.0 - 1.0 * t);
    std::vector<AgentDetection> seen;
    for (const Eigen::Vector2d& p : {a, b}) {
      const Eigen::Vector2d noise(random.normal(0.0, 0.08), random.normal(0.0, 0.08));
      if (random.chance(0.9)) seen.push_back(person(pose.inverse() * p + noise));
    }
    for (const MovingObservation& o : tracker.update(seen, pose, k * kStep)) {
      const Eigen::Vector2d p = pose * o.contact;
      const bool is_a = (p - a).norm() < (p - b).norm();
      (is_a ? first : second).insert(o.id);
      ++told;
      if (k < 12) continue;
      EXPECT_TRUE(o.moving);
      const Eigen::Vector2d v = pose.rotationMatrix() * o.velocity;
      EXPECT_LT((v - Eigen::Vector2d(0.0, is_a ? 1.2 : -1.0)).norm(), 0.6);
    }
  }
  EXPECT_EQ(first.size(), 1U);
  EXPECT_EQ(second.size(), 1U);
  EXPECT_GT(told, 45);
}

TEST(AgentTracker, ParkedCarsRestAlthoughTheirNearestPointMoves) {
  AgentTracker tracker({});
  Random random(8);
  GroundBox parked;
  parked.center = {6.0, 5.0};
  parked.heading = M_PI_2;
  parked.size = {4.6, 1.8};
  GroundBox driving;
  driving.size = {4.6, 1.8};
  std::set<std::uint64_t> ids;
  for (int k = 0; k < 25; ++k) {
    const double t = 0.2 * k;
    const SE2 pose(0.0, {1.5 * t, 0.0});
    driving.center = {12.0 - 1.5 * t, -2.0};
    std::vector<AgentDetection> seen;
    for (GroundBox box : {parked, driving}) {
      box.center = pose.inverse() * box.center;
      box.center += Eigen::Vector2d(random.normal(0.0, 0.05), random.normal(0.0, 0.05));
      seen.push_back(car(box));
    }
    for (const MovingObservation& o : tracker.update(seen, pose, k * kStep)) {
      const bool is_parked = (pose * o.contact).y() > 0.0;
      if (is_parked) {
        EXPECT_FALSE(o.moving);
      } else if (k > 10) {
        EXPECT_TRUE(o.moving);
        EXPECT_NEAR(o.velocity.x(), -1.5, 0.3);
        EXPECT_LT(std::abs(wrapAngle(o.heading - M_PI)), 0.1);
      }
      ids.insert(o.id);
    }
  }
  EXPECT_EQ(ids.size(), 2U);
}

// A car that crosses enters the picture bit by bit: its first metres pass for a front, across its
// way. Its whole side puts that right, and so does its course.
TEST(AgentTracker, ACarThatEntersBitByBitHeadsAlongItsWay) {
  for (const int stands_from : {12, 100}) {
    AgentTracker tracker({});
    std::vector<MovingObservation> told;
    for (int k = 0; k < 20; ++k) {
      const double front = -4.2 + 0.4 * std::min(k, stands_from);
      const double rear = std::max(-6.0, front - 4.6);  // nothing is seen beyond
      GroundBox seen;
      seen.center = {6.0, 0.5 * (front + rear)};
      seen.size = {0.4, front - rear};
      told = tracker.update({car(seen)}, {}, k * kStep);
    }
    ASSERT_EQ(told.size(), 1U) << stands_from;
    EXPECT_LT(std::abs(std::remainder(told[0].heading - M_PI_2, M_PI)), 0.2) << stands_from;
  }
}

// As it stops, its velocity becomes noise, which tells no course.
TEST(AgentTracker, ACarThatStopsKeepsItsHeading) {
  Random random(3);
  int turned = 0;
  int seen_to_stop = 0;
  for (int drive = 0; drive < 50; ++drive) {
    AgentTracker tracker({});
    std::vector<MovingObservation> told;
    double y = -8.0;
    double speed = 2.0;
    for (int k = 0; k < 30; ++k) {
      if (k > 12) speed = std::max(0.0, speed - 0.3);
      y += 0.2 * speed;
      GroundBox seen;
      seen.center = {6.0 + random.normal(0.0, 0.1), y + random.normal(0.0, 0.1)};
      seen.size = {1.8, 4.6};
      told = tracker.update({car(seen)}, {}, k * kStep);
    }
    if (told.size() != 1) continue;
    ++seen_to_stop;
    turned += std::abs(std::remainder(told[0].heading - M_PI_2, M_PI)) > 0.3 ? 1 : 0;
  }
  EXPECT_GT(seen_to_stop, 40);
  EXPECT_EQ(turned, 0);
}

TEST(AgentTracker, ComesToRestAndForgets) {
  AgentTracker tracker({});
  std::vector<MovingObservation> told;
  double x = 3.0;
  bool moved = false;
  for (int k = 0; k < 40; ++k) {
    if (k < 15) x += 0.24;
    told = tracker.update({person({x, 1.0})}, SE2(), k * kStep);
    if (!told.empty()) moved = moved || told.front().moving;
  }
  EXPECT_TRUE(moved);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_FALSE(told.front().moving);
  const std::uint64_t id = told.front().id;
  for (int k = 40; k < 50; ++k) EXPECT_TRUE(tracker.update({}, SE2(), k * kStep).empty());
  for (int k = 50; k < 53; ++k) told = tracker.update({person({x, 1.0})}, SE2(), k * kStep);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told.front().id, id);
}

}  // namespace
}  // namespace parkade
