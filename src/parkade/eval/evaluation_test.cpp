// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/evaluation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "parkade/eval/test_support.hpp"

namespace parkade {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::moved;
using testing::straight;
using testing::winding;

EvaluationOptions aligned(const std::string& method) {
  EvaluationOptions options;
  options.align = method;
  return options;
}

TEST(Evaluation, IdenticalTrajectoriesHaveNoError) {
  const Trajectory t = winding(300);
  for (const char* method : {"none", "origin", "yaw", "se3", "sim3"}) {
    const auto e = evaluate(t, t, aligned(method));
    ASSERT_TRUE(e.ok());
    EXPECT_LT(e->ape.max, 1e-9) << method;
    EXPECT_LT(e->ape_rotation_deg.max, 1e-6) << method;
    EXPECT_LT(e->rpe.max, 1e-9) << method;
    EXPECT_EQ(e->pairs.coverage, 1.0);
    EXPECT_NEAR(e->path_length, 0.5 * 299, 1e-9);
    EXPECT_TRUE(e->notes.empty()) << e->notes.front();
  }
}

TEST(Evaluation, EachAlignmentTakesAwayWhatItMay) {
  Random random(1);
  const Trajectory reference = winding(300);
  const SE3 yawed(SO3::fromYawPitchRoll(2.0, 0.0, 0.0), {5.0, -3.0, 1.0});
  const SE3 tilted(SO3::exp(testing::noise(random, 1.0)), {5.0, -3.0, 1.0});
  struct Case {
    const char* method;
    bool yaw, tilt, scale;
  };
  for (const Case& c : {Case{"none", false, false, false}, Case{"origin", true, true, false},
                        Case{"yaw", true, false, false}, Case{"se3", true, true, false},
                        Case{"sim3", true, true, true}}) {
    const auto of = [&](const Trajectory& estimate) {
      return evaluate(estimate, reference, aligned(c.method))->ape.rmse;
    };
    EXPECT_EQ(of(moved(reference, yawed)) < 1e-8, c.yaw) << c.method;
    EXPECT_EQ(of(moved(reference, tilted)) < 1e-8, c.tilt) << c.method;
    EXPECT_EQ(of(moved(reference, tilted, 1.7)) < 1e-8, c.scale) << c.method;
  }
  const auto similar = evaluate(moved(reference, tilted, 2.0), reference, aligned("sim3"));
  EXPECT_NEAR(similar->alignment.scale, 0.5, 1e-9);
  EXPECT_NEAR(similar->estimate_path_length, similar->path_length, 1e-6);
}

TEST(Evaluation, NoiseGivesItsSizeBack) {
  Random random(2);
  const Trajectory reference = winding(2000);
  Trajectory estimate = reference;
  for (auto& pose : estimate) {
    pose.T_world_body = SE3(pose.T_world_body.rotation() * SO3::exp(testing::noise(random, 0.01)),
                            pose.T_world_body.translation() + testing::noise(random, 0.05));
  }
  const auto e = evaluate(moved(estimate, SE3(SO3(), {100.0, 0.0, 0.0})), reference);
  ASSERT_TRUE(e.ok());
  EXPECT_NEAR(e->ape.rmse, 0.05 * std::sqrt(3.0), 0.003);
  EXPECT_NEAR(e->ape_rotation_deg.rmse, 0.01 * std::sqrt(3.0) * 180.0 / std::numbers::pi, 0.05);
  EXPECT_LT(e->ape.median, e->ape.rmse);
  EXPECT_LT(e->ape.rmse, e->ape.p95);
  EXPECT_LT(e->ape.p95, e->ape.max);
}

TEST(Evaluation, ClockOffset) {
  const Trajectory reference = winding(100);
  Trajectory estimate = reference;
  for (auto& pose : estimate) pose.t_ns += 7 * kNsPerSecond;
  EvaluationOptions options;
  options.association.offset_s = -7.0;
  const auto e = evaluate(estimate, reference, options);
  ASSERT_TRUE(e.ok());
  EXPECT_EQ(e->pairs.size(), 100u);
  EXPECT_LT(e->ape.max, 1e-9);
  EXPECT_EQ(e->estimate.front().t_ns, reference.front().t_ns);
}

TEST(Evaluation, InterpolationRemovesTheErrorOfUnevenStamps) {
  // The reference at 10 Hz and 1 m per pose; the estimate lies exactly between its poses.
  const Trajectory reference = winding(200);
  Trajectory estimate;
  for (std::size_t i = 0; i + 1 < reference.size(); ++i) {
    estimate.push_back(
        {reference[i].t_ns + 50 * kNsPerMs,
         interpolate(reference[i].T_world_body, reference[i + 1].T_world_body, 0.5)});
  }
  EvaluationOptions options = aligned("none");
  options.association.tolerance_s = 0.05;
  EXPECT_GT(evaluate(estimate, reference, options)->ape.rmse, 0.2);
  options.association.interpolate = true;
  EXPECT_LT(evaluate(estimate, reference, options)->ape.rmse, 1e-9);
}

TEST(Evaluation, NotesWhatIsNotDetermined) {
  const auto line = evaluate(straight(100), straight(100));
  ASSERT_TRUE(line.ok());
  EXPECT_LT(line->ape.max, 1e-9);
  EXPECT_LT(line->ape_rotation_deg.max, 1e-6);
  EXPECT_THAT(line->notes, ElementsAre(HasSubstr("all points on one line")));

  const auto brief = evaluate(winding(10), winding(10));
  ASSERT_TRUE(brief.ok());
  EXPECT_EQ(brief->rpe.count, 0u);
  EXPECT_THAT(brief->notes, ElementsAre(HasSubstr("--rpe-delta")));

  const Trajectory parked = testing::standing(5);
  const auto still = evaluate(parked, parked);
  ASSERT_TRUE(still.ok());
  EXPECT_THAT(still->notes, ElementsAre(HasSubstr("all points at one place"),
                                        HasSubstr("--rpe-delta"), HasSubstr("to tell the drift")));

  const auto one = evaluate(straight(1), straight(1));
  ASSERT_TRUE(one.ok());
  EXPECT_EQ(one->ape.max, 0.0);
}

TEST(Evaluation, RefusesWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::array<EvaluationOptions, 4> options;
  options[0].association.tolerance_s = nan;
  options[1].association.offset_s = nan;
  options[2].association.max_gap_s = nan;
  options[3].rpe.delta = nan;
  for (const EvaluationOptions& one : options) {
    const auto e = evaluate(straight(10), straight(10), one);
    ASSERT_FALSE(e.ok());
    EXPECT_THAT(e.error().message, HasSubstr("expected numbers"));
  }
}

TEST(Evaluation, RefusesUnknownAlignment) {
  const auto e = evaluate(straight(10), straight(10), aligned("icp"));
  ASSERT_FALSE(e.ok());
  EXPECT_THAT(e.error().message, HasSubstr("'icp'"));
}

TEST(Evaluation, OptionsCarryTheirRanges) {
  EvaluationOptions options;
  EXPECT_TRUE(setOption(asOptions(options), "rpe.unit=s").ok());
  EXPECT_EQ(options.rpe.unit, "s");
  EXPECT_FALSE(setOption(asOptions(options), "align=icp").ok());
  EXPECT_FALSE(setOption(asOptions(options), "association.tolerance_s=-1").ok());
}

}  // namespace
}  // namespace parkade
