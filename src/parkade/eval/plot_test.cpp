// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "parkade/eval/test_support.hpp"

namespace parkade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::winding;

int countOf(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Plot, LongTrajectoriesStaySmall) {
  Random random(1);
  const Trajectory reference = winding(40000, 0.005);
  Trajectory estimate = reference;
  for (auto& pose : estimate) pose.T_world_body.translation() += testing::noise(random, 0.05);
  const std::string svg = evaluationSvg(*evaluate(estimate, reference), reference);
  EXPECT_LT(svg.size(), 150'000u);
  EXPECT_THAT(svg, ::testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(svg, ::testing::EndsWith("</svg>\n"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_EQ(countOf(svg, "<g "), countOf(svg, "</g>"));
  EXPECT_THAT(svg, HasSubstr(">x (m)<"));
  EXPECT_THAT(svg, HasSubstr(">y (m)<"));
}

TEST(Plot, CameraFramesAreSeenFromAbove) {
  const SE3 T_cam_vehicle(SO3((Eigen::Matrix3d() << 0, -1, 0, 0, 0, -1, 1, 0, 0).finished()),
                          {0, 0, 0});
  const Trajectory reference = testing::moved(winding(300), T_cam_vehicle);
  const Evaluation e = *evaluate(reference, reference);
  EXPECT_THAT(evaluationSvg(e, reference), HasSubstr(">z (m)<"));
  EXPECT_THAT(evaluationSvg(e, reference), HasSubstr("Height: y"));
  EXPECT_THAT(evaluationSvg(e, reference, {}, PlotPlane::kXy), HasSubstr("Height: z"));
}

TEST(Plot, BreaksLinesAtHoles) {
  const Trajectory reference = winding(300);
  Trajectory estimate = reference;
  estimate.erase(estimate.begin() + 100, estimate.begin() + 200);
  const std::string whole = evaluationSvg(*evaluate(reference, reference), reference);
  const std::string broken = evaluationSvg(*evaluate(estimate, reference), reference);
  const std::string line = "<polyline class=\"est\"";
  // Top view, two error curves, profile.
  EXPECT_EQ(countOf(whole, line), 4);
  EXPECT_EQ(countOf(broken, line), 8);
}

TEST(Plot, DegenerateInputStillDraws) {
  for (const Trajectory& t : {testing::straight(1), testing::straight(2), testing::standing(5)}) {
    const std::string svg = evaluationSvg(*evaluate(t, t), t);
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
  }
}

}  // namespace
}  // namespace parkade
