// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/loop_score.hpp"

#include <gtest/gtest.h>

#include "parkade/geometry/se2.hpp"

namespace parkade {
namespace {

// Along x, back to where it began after 10 s, a node each second; the map lies elsewhere.
struct Drive {
  Drive() {
    for (int k = 0; k <= 100; ++k) {
      const double along = 0.4 * std::min(k, 100 - k);
      driven.push_back({100'000'000LL * k, SE3(SO3(), {along, 0.0, 0.0})});
    }
    const SE3 T_map_truth = SE2(0.7, {3.0, -1.0}).toSE3();
    for (int k = 0; k <= 10; ++k) {
      const StampedPose& pose = driven[static_cast<std::size_t>(10 * k)];
      map.nodes.push_back({k, pose.t_ns, T_map_truth * pose.T_world_body});
    }
  }
  void close(int from, int to, const SE2& error, const Eigen::Vector3d& information) {
    PoseGraphEdge edge;
    edge.from = from;
    edge.to = to;
    edge.kind = EdgeKind::kLoop;
    const auto at = [&](int k) { return driven[static_cast<std::size_t>(10 * k)].T_world_body; };
    edge.T_from_to = at(from).inverse() * at(to) * error.toSE3();
    edge.information.setZero();
    edge.information.diagonal() << information.x(), information.y(), 0, 0, 0, information.z();
    map.edges.push_back(edge);
  }
  Trajectory driven;
  ParkingMap map;
};

const Eigen::Vector3d kAll(1e4, 1e4, 1e4);

TEST(LoopScore, RightClosuresErrByWhatTheyErr) {
  Drive drive;
  drive.close(1, 9, SE2(0.01, {0.03, 0.04}), kAll);
  drive.close(0, 10, SE2(), kAll);
  const LoopScore score = scoreLoops(drive.map, drive.driven);
  EXPECT_EQ(score.told, 2);
  EXPECT_EQ(score.wrong, 0);
  EXPECT_NEAR(score.error.max, 0.05, 1e-9);
  EXPECT_NEAR(score.turn.max, 0.01 * 180.0 / M_PI, 1e-9);
}

TEST(LoopScore, TheNextSlotIsWrong) {
  Drive drive;
  drive.close(1, 9, SE2(0.0, {2.5, 0.0}), kAll);
  drive.close(2, 8, SE2(0.2, {0.0, 0.0}), kAll);
  drive.close(3, 7, SE2(), kAll);
  const LoopScore score = scoreLoops(drive.map, drive.driven);
  EXPECT_EQ(score.told, 3);
  EXPECT_EQ(score.wrong, 2);
}

TEST(LoopScore, CountsOnlyWhatAClosureKnows) {
  Drive drive;
  drive.close(1, 9, SE2(0.0, {2.5, 0.1}), {0.0, 1e4, 1e4});  // a line: nothing along it
  drive.close(2, 8, SE2(0.5, {0.0, 0.0}), {1e4, 1e4, 0.0});
  const LoopScore score = scoreLoops(drive.map, drive.driven);
  EXPECT_EQ(score.wrong, 0);
  EXPECT_NEAR(score.error.max, 0.1, 1e-9);
  EXPECT_EQ(score.turn.count, 1U);
}

TEST(LoopScore, LeavesOutOdometryAndWhatTheTruthDoesNotCover) {
  Drive drive;
  drive.close(1, 2, SE2(0.0, {5.0, 0.0}), kAll);
  drive.map.edges.back().kind = EdgeKind::kOdometry;
  drive.close(1, 9, SE2(), kAll);
  drive.map.nodes[9].t_ns += fromSeconds(1000.0);
  const LoopScore score = scoreLoops(drive.map, drive.driven);
  EXPECT_EQ(score.told, 0);
  EXPECT_EQ(score.error.count, 0U);
  const ParkingMap empty;
  EXPECT_EQ(scoreLoops(empty, drive.driven).told, 0);
}

}  // namespace
}  // namespace parkade
