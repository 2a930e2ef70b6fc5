// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/agents.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/sim/world/agent_motion.hpp"
#include "parkade/sim/world/aisle_graph.hpp"
#include "parkade/sim/world/generate.hpp"

namespace parkade::sim {
namespace {

TEST(BoxDistance, KnownCases) {
  const Eigen::Vector2d half(2.0, 1.0);
  EXPECT_NEAR(boxDistance({0, 0, 0}, half, {5, 0, 0}, half), 1.0, 1e-12);
  EXPECT_NEAR(boxDistance({0, 0, 0}, half, {5, 3, 0}, half), std::hypot(1.0, 1.0), 1e-12);
  EXPECT_NEAR(boxDistance({0, 0, 0}, half, {4, 0, M_PI / 2}, half), 1.0, 1e-12);
  EXPECT_EQ(boxDistance({0, 0, 0}, {3.0, 0.2}, {0, 0, M_PI / 2}, {3.0, 0.2}), 0.0);  // a plus
  EXPECT_NEAR(boxDistance({0, 0, M_PI / 4}, {1.0, 1.0}, {3, 0, 0}, {1.0, 1.0}),
              2.0 - std::sqrt(2.0), 1e-12);
}

AgentTrack straightTrack(double length) {
  AgentTrack track;
  for (int i = 0; i <= static_cast<int>(length / AgentTrack::kSpacing); ++i) {
    track.poses.emplace_back(i * AgentTrack::kSpacing, 0.0, 0.0);
  }
  return track;
}

TEST(PlanSchedule, DrivesFreelyAndStopsAtTheEnd) {
  const auto schedule = planSchedule(straightTrack(30.0), {2.0, 0.9}, {}, {}, 40.0);
  ASSERT_TRUE(schedule);
  EXPECT_EQ(schedule->distance(0.0), 0.0);
  EXPECT_GT(schedule->distance(40.0), 28.0);
  for (double t = 0.0; t < 39.9; t += 0.1) {
    EXPECT_GE(schedule->distance(t + 0.1), schedule->distance(t) - 1e-12);
    EXPECT_LE(schedule->speed(t), 3.0 + 1e-12);
  }
}

TEST(PlanSchedule, WaitsForWhatCrosses) {
  // A box that passes over the track's middle from 5 to 12 s.
  const MovingBox box{[](double t) { return Eigen::Vector3d(15.0, 20.0 - 2.5 * t, M_PI / 2); }, 2.3,
                      0.9};
  const AgentTrack track = straightTrack(30.0);
  const auto schedule = planSchedule(track, {2.0, 0.9}, {box}, {}, 30.0);
  ASSERT_TRUE(schedule);
  for (double t = 0.0; t <= 30.0; t += 0.02) {
    EXPECT_GE(boxDistance(track.at(schedule->distance(t)), {2.0, 0.9}, box.pose(t), {2.3, 0.9}),
              0.8)
        << "t = " << t;
  }
  EXPECT_GT(schedule->distance(30.0), 25.0);
}

TEST(PlanSchedule, StopsCloseBehindWhatStandsAnywhereOnTheWay) {
  for (double ahead = 6.0; ahead < 58.0; ahead += 1.7) {
    const MovingBox standing{[ahead](double) { return Eigen::Vector3d(ahead, 0.0, 0.0); }, 2.0,
                             1.0};
    const auto schedule = planSchedule(straightTrack(60.0), {2.0, 0.9}, {standing}, {}, 30.0);
    ASSERT_TRUE(schedule) << ahead;
    // Half of both lengths; the clearance of 0.8 m with its reserve of 0.3 m.
    const double limit = ahead - 4.0 - 1.1;
    EXPECT_LE(schedule->distance(30.0), limit + 1e-9);
    EXPECT_GT(schedule->distance(30.0), limit - 0.5);
  }
}

TEST(PlanSchedule, KeepsClearOnAWindingWay) {
  AgentTrack round;
  for (double s = 0.0; s < 106.0; s += AgentTrack::kSpacing) {
    round.poses.emplace_back(10.0 * std::cos(0.1 * s), 10.0 * std::sin(0.1 * s),
                             0.1 * s + M_PI / 2);
  }
  // One crosses the circle twice, one stands in its middle, one drives past outside.
  const std::vector<MovingBox> boxes = {
      {[](double t) { return Eigen::Vector3d(0.7 * t - 20.0, 0.5, 0.0); }, 2.3, 0.9},
      {[](double) { return Eigen::Vector3d(0.0, 0.0, 1.0); }, 2.3, 0.9},
      {[](double t) { return Eigen::Vector3d(16.0, 30.0 - t, -M_PI / 2); }, 2.3, 0.9}};
  const Eigen::Vector2d half(0.35, 0.28);
  const auto schedule = planSchedule(round, half, boxes, {}, 60.0);
  ASSERT_TRUE(schedule);
  for (double t = 0.0; t <= 60.0; t += 0.05) {
    for (const MovingBox& box : boxes) {
      EXPECT_GE(boxDistance(round.at(schedule->distance(t)), half, box.pose(t),
                            {box.half_length, box.half_width}),
                0.8)
          << "t = " << t;
    }
  }
  // Those that never come near change nothing.
  const auto alone = planSchedule(round, half, {boxes[0]}, {}, 60.0);
  ASSERT_TRUE(alone);
  for (double t = 0.0; t <= 60.0; t += 0.25) {
    EXPECT_EQ(schedule->distance(t), alone->distance(t));
  }
}

TEST(PlanSchedule, FindsNothingWhereThereIsNothing) {
  const MovingBox standing{[](double) { return Eigen::Vector3d(0.0, 0.0, 0.0); }, 2.0, 1.0};
  EXPECT_FALSE(planSchedule(straightTrack(10.0), {2.0, 0.9}, {standing}, {}, 10.0));
}

// The own car drives round the aisles without stopping, in the middle of them.
EgoInput egoAlongAisles(const Garage& garage, double duration) {
  std::vector<Eigen::Vector2d> way;
  int before = -1;
  int node = 0;
  while (way.size() < 12) {
    way.push_back(garage.aisles.nodes[static_cast<std::size_t>(node)]);
    for (const int next : neighboursOf(garage.aisles, node)) {
      if (next == before) continue;
      before = node;
      node = next;
      break;
    }
  }
  EgoInput ego;
  ego.shape = VehicleShape{};
  ego.duration = duration;
  ego.pose = [way](double t) {
    double left = 2.5 * t;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      const Eigen::Vector2d step = way[i + 1] - way[i];
      if (left <= step.norm() || i + 2 == way.size()) {
        const Eigen::Vector2d p = way[i] + std::min(1.0, left / step.norm()) * step;
        return Eigen::Vector3d(p.x(), p.y(), std::atan2(step.y(), step.x()));
      }
      left -= step.norm();
    }
    return Eigen::Vector3d(way[0].x(), way[0].y(), 0.0);
  };
  return ego;
}

TEST(Agents, KeepClearOfTheOwnCarAndComeIntoItsView) {
  constexpr double kDuration = 40.0;
  int moving = 0;
  int near = 0;
  for (int seed = 0; seed < 4; ++seed) {
    GarageOptions options;
    options.seed = seed;
    const Result<Garage> garage = generateGarage(options);
    ASSERT_TRUE(garage) << garage.error().message;
    const EgoInput ego = egoAlongAisles(*garage, kDuration);
    Scene scene;
    const CarMaterials materials = addCarMaterials(scene);
    addAgents(*garage, 2, 3, ego, materials, Random(static_cast<std::uint64_t>(seed)), scene);
    const VehicleShape shape;
    const double length = shape.wheelbase + shape.front_overhang + shape.rear_overhang;
    for (const MovingObject& object : scene.moving) {
      ++moving;
      double least = 1e9;
      for (double t = 0.0; t <= kDuration; t += 0.05) {
        const SE3 pose = object.pose(t);
        const Eigen::Vector3d mine(pose.translation().x(), pose.translation().y(),
                                   pose.rotation().yaw());
        Eigen::Vector3d own = ego.pose(t);
        const double ahead = 0.5 * length - shape.rear_overhang;
        own.head<2>() += ahead * Eigen::Vector2d(std::cos(own.z()), std::sin(own.z()));
        const Eigen::Vector2d half = 0.5 * object.box_size.head<2>();
        least = std::min(least, boxDistance(mine, half, own, {0.5 * length, 0.5 * shape.width}));
        const int mesh = object.mesh(t);
        ASSERT_GE(mesh, 0);
        ASSERT_LT(mesh, static_cast<int>(scene.meshes.size()));
      }
      EXPECT_GE(least, 0.8) << "seed " << seed << ", instance " << object.instance;
      near += least < 6.0 ? 1 : 0;
    }
  }
  EXPECT_GE(moving, 10);
  EXPECT_GE(near, 3);
}

TEST(Agents, SameSeedSameMotion) {
  const Result<Garage> garage = generateGarage({});
  ASSERT_TRUE(garage);
  const EgoInput ego = egoAlongAisles(*garage, 20.0);
  Scene a;
  Scene b;
  addAgents(*garage, 1, 2, ego, addCarMaterials(a), Random(5), a);
  addAgents(*garage, 1, 2, ego, addCarMaterials(b), Random(5), b);
  ASSERT_EQ(a.moving.size(), b.moving.size());
  for (std::size_t i = 0; i < a.moving.size(); ++i) {
    EXPECT_EQ(a.moving[i].pose(7.3).translation(), b.moving[i].pose(7.3).translation());
  }
}

}  // namespace
}  // namespace parkade::sim
