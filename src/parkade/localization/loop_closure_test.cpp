// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/loop_closure.hpp"

#include <gmock/gmock.h>

#include "parkade/mapping/synthetic_plan.hpp"

namespace parkade {
namespace {

using testing::makePlan;
using testing::Plan;
using testing::PlanObserver;
using testing::usualNoise;

Submap submapAt(const PlanObserver& observer, double x, Random& random) {
  Submap submap;
  for (int k = 0; k < 20; ++k) {
    const SE2 local(0.0, {0.25 * k, 0.0});
    submap.add(observer.observe(0, SE2(0.0, {x, 0.0}) * local, random, false), local);
  }
  return submap;
}

TEST(LoopClosure, LookAlikeRowIsRefused) {
  Plan plan = makePlan(1, 80.0, 0.0, 3);
  plan.objects.clear();  // nothing but slots, each like the next
  const PlanObserver observer(plan, usualNoise());
  Random random(1);
  const Submap submap = submapAt(observer, 30.0, random);
  int accepted = 0;
  for (int round = 0; round < 6; ++round) {
    const SE2 truth(0.0, {random.uniform(0.0, 4.0), 0.0});
    // Wrong by a whole slot: the one next to it fits as well.
    const SE2 expected = truth * SE2(0.0, {round % 2 == 0 ? 2.5 : -2.5, 0.1});
    const LoopResult r =
        searchInSubmap(observer.observe(0, SE2(0.0, {30.0, 0.0}) * truth, random, false), submap,
                       expected, 1.2, 0.01, {}, {});
    accepted += r.accepted ? 1 : 0;
  }
  EXPECT_EQ(accepted, 0);
}

TEST(LoopClosure, ArrowsAndMarkersDecideAndWrongPlacesNeverWin) {
  Random random(2);
  int accepted = 0;
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    const PlanObserver observer(makePlan(1, 80.0, 0.3, 10 + static_cast<std::uint64_t>(round)),
                                usualNoise());
    const Submap submap = submapAt(observer, 30.0, random);
    const SE2 truth(0.0, {random.uniform(0.0, 4.0), random.uniform(-0.5, 0.5)});
    const SE2 expected =
        truth * SE2(0.01 * random.normal(), {1.0 * random.normal(), 0.5 * random.normal()});
    const LoopResult r =
        searchInSubmap(observer.observe(0, SE2(0.0, {30.0, 0.0}) * truth, random, false), submap,
                       expected, 1.2, 0.01, {}, {});
    if (!r.accepted) continue;
    ++accepted;
    const double error = (r.registration.T_map_vehicle.translation() - truth.translation()).norm();
    EXPECT_LT(error, 0.06) << "round " << round << ": a false loop";
  }
  std::printf("loops found in %d of %d rounds\n", accepted, kRounds);
  EXPECT_GE(accepted, kRounds / 2);
}

TEST(LoopClosure, OtherAisleAndTooUncertainPosesAreRefused) {
  Random random(3);
  Plan plan = makePlan(2, 80.0, 0.3, 5);
  const PlanObserver observer(plan, usualNoise());
  const Submap submap = submapAt(observer, 30.0, random);
  // The second aisle looks like the first but for its arrows' direction and its markers' texts.
  const SemanticFrame other = observer.observe(0, SE2(0.0, {32.0, 16.0}), random, false);
  EXPECT_FALSE(searchInSubmap(other, submap, SE2(0.0, {2.0, 0.0}), 1.2, 0.01, {}, {}).accepted);
  const SemanticFrame frame = observer.observe(0, SE2(0.0, {32.0, 0.0}), random, false);
  const LoopResult r = searchInSubmap(frame, submap, SE2(0.0, {2.0, 0.0}), 3.0, 0.01, {}, {});
  EXPECT_FALSE(r.accepted);
  EXPECT_THAT(r.reason, ::testing::HasSubstr("uncertain by 3.0 m"));
}

// Rows of slots and arrows that all say "straight" look alike four metres on, and markers that the
// submap never read have no say in it.
TEST(PlaceDecision, OnlyNamesThatWereReadTellAPlace) {
  SemanticFrame frame;
  Submap submap;
  const auto put = [&](SemanticClass c, double x, const std::string& seen,
                       const std::string& read) {
    ObjectObservation object;
    object.semantic_class = c;
    object.position = {x, 2.0, 0.0};
    object.text = seen;
    frame.objects.push_back(object);
    PointFeature point;
    point.p = {x, 2.0};
    point.covariance = 1e-4 * Eigen::Matrix2d::Identity();
    point.semantic_class = c;
    point.text = read;
    point.count = 2;
    submap.addPoint(point);
  };
  for (int k = 0; k < 8; ++k) put(SemanticClass::kArrow, 3.0 * k, "straight", "straight");
  for (int k = 0; k < 4; ++k)
    put(SemanticClass::kZoneMarker, 3.0 * k, "B1" + std::to_string(k), "");
  PlaceRules rules;
  rules.wrong_texts = 0.25;
  rules.enough_texts = 4;
  EXPECT_FALSE(textsSuffice(frame, submap, {}, rules));
  EXPECT_FALSE(textsContradict(frame, submap, {}, rules));
  for (int k = 4; k < 6; ++k) put(SemanticClass::kZoneMarker, 3.0 * k, "B1", "C7");
  EXPECT_TRUE(textsContradict(frame, submap, {}, rules));
  frame.objects.clear();
  for (int k = 6; k < 10; ++k) {
    const std::string text = "B1" + std::to_string(k);
    put(SemanticClass::kZoneMarker, 3.0 * k, text, text);
  }
  EXPECT_TRUE(textsSuffice(frame, submap, {}, rules));
}

}  // namespace
}  // namespace parkade
