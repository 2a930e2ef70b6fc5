// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/pose_graph.hpp"

#include <gmock/gmock.h>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

// Once around a square of four sides of ten poses each.
std::vector<SE3> squareDrive() {
  std::vector<SE3> poses = {SE3()};
  for (int side = 0; side < 4; ++side) {
    for (int k = 0; k < 10; ++k) {
      const double turn = k == 9 ? 0.5 * M_PI : 0.0;
      poses.push_back(poses.back() * SE3(SO3::fromYawPitchRoll(turn, 0.0, 0.0), {2.0, 0.0, 0.0}));
    }
  }
  return poses;
}

PoseGraphEdge edgeBetween(std::int64_t a, std::int64_t b, const SE3& T, EdgeKind kind) {
  PoseGraphEdge edge;
  edge.from = a;
  edge.to = b;
  edge.kind = kind;
  edge.T_from_to = T;
  edge.information.diagonal() << 1e4, 1e4, 1e4, 1e6, 1e6, 1e6;
  return edge;
}

struct Graph {
  std::vector<SE3> truth = squareDrive();
  std::vector<PoseGraphNode> nodes;
  std::vector<PoseGraphEdge> edges;

  explicit Graph(double yaw_error) {
    SE3 pose;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto id = static_cast<std::int64_t>(100 + i);
      if (i > 0) {
        const SE3 step = truth[i - 1].inverse() * truth[i] *
                         SE3(SO3::fromYawPitchRoll(yaw_error, 0.0, 0.0), Eigen::Vector3d::Zero());
        pose = pose * step;
        edges.push_back(edgeBetween(id - 1, id, step, EdgeKind::kOdometry));
      }
      nodes.push_back({id, static_cast<TimeNs>(i), pose});
    }
  }
  [[nodiscard]] double error(std::size_t i) const {
    return (nodes[i].T_world_vehicle.translation() - truth[i].translation()).norm();
  }
};

TEST(PoseGraph, LoopMendsTheWayBetween) {
  Graph g(0.005);
  ASSERT_GT(g.error(40), 2.0);
  const double middle = g.error(20);
  g.edges.push_back(edgeBetween(100, 140, g.truth[40], EdgeKind::kLoop));
  const PoseGraphResult result = optimisePoseGraph(g.nodes, g.edges, 1e6);
  EXPECT_TRUE(result.usable);
  EXPECT_LT(result.final_cost, 0.1 * result.initial_cost);
  EXPECT_LT(g.error(40), 0.05);
  EXPECT_LT(g.error(20), 0.6 * middle);
  EXPECT_EQ(g.error(0), 0.0);  // the first stays
}

TEST(PoseGraph, ConsistentGraphStaysAsItIs) {
  Graph g(0.0);
  g.edges.push_back(edgeBetween(105, 130, g.truth[5].inverse() * g.truth[30], EdgeKind::kLoop));
  optimisePoseGraph(g.nodes, g.edges);
  for (std::size_t i = 0; i < g.truth.size(); ++i) EXPECT_NEAR(g.error(i), 0.0, 1e-9);
}

TEST(PoseGraph, WrongLoopBendsLittle) {
  Graph g(0.0);
  g.edges.push_back(edgeBetween(100, 120, g.truth[25], EdgeKind::kLoop));  // ten metres off
  optimisePoseGraph(g.nodes, g.edges);
  for (std::size_t i = 0; i < g.truth.size(); ++i) EXPECT_LT(g.error(i), 0.1) << i;
}

TEST(PoseGraph, EdgeWithoutInformationAcrossIsFreeThere) {
  std::vector<PoseGraphNode> nodes = {{1, 0, SE3()}, {2, 1, SE3(SO3(), {1.0, 0.5, 0.0})}};
  PoseGraphEdge edge = edgeBetween(1, 2, SE3(SO3(), {2.0, 3.0, 0.0}), EdgeKind::kOdometry);
  edge.information.setZero();
  edge.information(0, 0) = 100.0;
  ASSERT_TRUE(optimisePoseGraph(nodes, {edge}).usable);
  EXPECT_NEAR(nodes[1].T_world_vehicle.translation().x(), 2.0, 1e-3);
  EXPECT_NEAR(nodes[1].T_world_vehicle.translation().y(), 0.5, 1e-3);
}

TEST(PoseGraph, NothingToDoIsNoHarm) {
  std::vector<PoseGraphNode> nodes = {{1, 0, SE3()}, {2, 1, SE3()}};
  EXPECT_FALSE(optimisePoseGraph(nodes, {}).usable);
  EXPECT_FALSE(optimisePoseGraph(nodes, {edgeBetween(1, 7, SE3(), EdgeKind::kLoop)}).usable);
}

}  // namespace
}  // namespace parkade
