// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/avp_slam.hpp"

#include <gmock/gmock.h>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/synthetic_plan.hpp"

namespace parkade {
namespace {

constexpr double kDegree = M_PI / 180.0;

struct Outcome {
  double odometry_rmse = 0.0;
  double rmse = 0.0;
  double final_rmse = 0.0;
  AvpSlamStatistics statistics;
  Trajectory trajectory;
  Trajectory final_trajectory;
  ParkingMap map;
};

// Twice around a block with an odometry whose metres are too long and that turns slowly; features
// come a few poses after their picture.
Outcome drive(int laps, std::size_t delay, std::uint64_t seed) {
  const testing::Plan plan = testing::makePlan(2, 40.0, 0.5, seed);
  testing::ObserverNoise noise;
  noise.label_noise = 0.01;
  const testing::PlanObserver observer(plan, noise);
  constexpr double kStep = 1.0;
  const std::vector<SE2> poses = testing::blockDrive(40.0, laps, kStep);
  AvpSlam slam{AvpSlamOptions()};
  Random random(seed);
  SE2 odometry;
  Outcome result;
  std::vector<SemanticFrame> waiting;
  std::vector<SE2> truth;
  std::vector<SE2> reckoned;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (k > 0) {
      const Eigen::Vector3d d = (poses[k - 1].inverse() * poses[k]).log();
      odometry = odometry * SE2::exp({1.004 * d.x(), d.y() + 0.002 * random.normal(),
                                      d.z() + kDegree * 0.01 * kStep});
    }
    PoseEstimate pose;
    pose.t_ns = 100'000'000LL * static_cast<TimeNs>(k + 1);
    pose.T_odom_vehicle = odometry.toSE3();
    pose.health = Health::kTracking;
    if (waiting.size() > delay) {
      slam.addSemantics(waiting.front(), {});
      waiting.erase(waiting.begin());
    }
    const PoseEstimate e = slam.addOdometry(pose);
    slam.holdView();
    waiting.push_back(observer.observe(pose.t_ns, poses[k], random, true));
    result.trajectory.push_back({e.t_ns, e.T_odom_vehicle});
    truth.push_back(poses.front().inverse() * poses[k]);
    reckoned.push_back(odometry);
  }
  for (const SemanticFrame& frame : waiting) slam.addSemantics(frame, {});
  slam.finish();
  result.final_trajectory = slam.finalTrajectory();
  const auto rmse = [&](const auto& at) {
    double sum = 0.0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      sum += (at(k) - truth[k].translation()).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(truth.size()));
  };
  const auto of = [](const Trajectory& t) {
    return [&t](std::size_t k) -> Eigen::Vector2d {
      return t[k].T_world_body.translation().head<2>();
    };
  };
  result.odometry_rmse = rmse([&](std::size_t k) { return reckoned[k].translation(); });
  result.rmse = rmse(of(result.trajectory));
  result.final_rmse = rmse(of(result.final_trajectory));
  result.statistics = slam.statistics();
  result.map = slam.map("synthetic");
  return result;
}

TEST(AvpSlam, ClosesLoopsAndIsBetterThanItsOdometry) {
  const Outcome r = drive(2, 2, 3);
  std::printf("odometry %.3f m, avp-slam %.3f m, final %.3f m; %d of %d registrations, %d loops\n",
              r.odometry_rmse, r.rmse, r.final_rmse, r.statistics.accepted,
              r.statistics.registrations, r.statistics.loops);
  EXPECT_LT(r.rmse, 0.7 * r.odometry_rmse);
  EXPECT_LT(r.final_rmse, 0.7 * r.odometry_rmse);
  EXPECT_GT(r.statistics.accepted, 50);
  EXPECT_GT(r.statistics.loops, 0);
  EXPECT_EQ(r.final_trajectory.size(), r.trajectory.size());
  EXPECT_TRUE(findFaults(r.map).empty());
  EXPECT_TRUE(r.map.grid.bounds(GridLayer::kParkingLines).has_value());
}

TEST(AvpSlam, SameCallsGiveTheSamePoses) {
  const Outcome a = drive(1, 1, 4);
  const Outcome b = drive(1, 1, 4);
  ASSERT_EQ(a.trajectory.size(), b.trajectory.size());
  for (std::size_t k = 0; k < a.trajectory.size(); ++k) {
    EXPECT_EQ(a.trajectory[k].T_world_body.translation(),
              b.trajectory[k].T_world_body.translation());
  }
  EXPECT_TRUE(a.map.grid == b.map.grid);
}

}  // namespace
}  // namespace parkade
