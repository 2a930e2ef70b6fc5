// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/synthetic_plan.hpp"
#include "parkade/pipeline/fused_mapper.hpp"

namespace parkade {
namespace {

using testing::makePlan;
using testing::Plan;
using testing::PlanObserver;
using testing::usualNoise;

struct Localised {
  int poses = 0;          // with a place in the map
  double found_m = -1.0;  // way to the first of them
  double worst = 0.0;     // of them, m
  double worst_yaw = 0.0;
  double height_sigma = 0.0;     // m, the largest told
  double nees = 0.0;             // mean, place in the plane
  double last_off = 0.0;         // m, of the last pose told
  double silent_after_m = -1.0;  // the last way after a mishap where no place was told
  double worst_before = 0.0;     // m, of the final poses before a mishap
  ParkingMap map;
  Trajectory final_poses;
};

// What goes wrong with the odometry on the way: a step that it does not know of, or says that it
// may have missed.
struct Mishap {
  double at = 1e9;  // m, way travelled
  SE2 missed;
  bool told = false;
};

// Drives through a plan with an odometry that drifts, in a map of it that lies at T_map_plan.
Localised drive(const Plan& plan, const ParkingMap& saved, const SE2& T_map_plan, double length,
                const Mishap& mishap = {}) {
  const PlanObserver observer(plan, usualNoise());
  FusedMapperOptions options;
  options.odometry.translation = 0.008;
  options.odometry.yaw_deg = 0.02;
  FusedMapper mapper(options, {});
  EXPECT_TRUE(mapper.locateIn(saved).ok());
  Random random(8);
  constexpr double kStep = 0.25;
  SE2 odometry;
  const std::vector<SE2> poses = testing::blockDrive(60.0, 1, kStep);
  Localised result;
  double way = 0.0;
  for (std::size_t k = 0; k < poses.size() && way < length; ++k) {
    if (k > 0) {
      const Eigen::Vector3d d = (poses[k - 1].inverse() * poses[k]).log();
      odometry = odometry * SE2::exp({1.002 * d.x() + 0.001 * random.normal(), d.y(),
                                      d.z() + 2e-5 + 1e-4 * random.normal()});
      way += kStep;
    }
    const bool mishap_now = way >= mishap.at && way < mishap.at + kStep;
    if (mishap_now) odometry = odometry * mishap.missed.inverse();
    PoseEstimate vio;
    vio.t_ns = 100'000'000LL * static_cast<TimeNs>(k + 1);
    vio.T_odom_vehicle = odometry.toSE3();
    vio.health = mishap_now && mishap.told ? Health::kLost : Health::kTracking;
    if (way >= mishap.at && mishap.told) {
      vio.covariance.topLeftCorner<2, 2>() = 9.0 * Eigen::Matrix2d::Identity();
      vio.covariance(5, 5) = 0.1;
    }
    mapper.addOdometry(vio);
    const PoseEstimate fused =
        mapper.addSemantics(observer.observe(vio.t_ns, poses[k], random, false), {});
    if (fused.health == Health::kInitialising) {
      result.silent_after_m = way >= mishap.at ? way : result.silent_after_m;
      continue;
    }
    result.last_off =
        (SE2::fromSE3(fused.T_odom_vehicle).inverse() * T_map_plan * poses[k]).translation().norm();
    if (result.poses++ == 0) result.found_m = way;
    const SE2 off = SE2::fromSE3(fused.T_odom_vehicle).inverse() * T_map_plan * poses[k];
    result.worst = std::max(result.worst, off.translation().norm());
    result.worst_yaw = std::max(result.worst_yaw, std::abs(off.angle()));
    result.height_sigma = std::max(result.height_sigma, std::sqrt(fused.covariance(2, 2)));
    const Eigen::Matrix2d P = fused.covariance.topLeftCorner<2, 2>();
    result.nees += off.translation().dot(P.inverse() * off.translation());
  }
  result.nees /= std::max(1, result.poses);
  mapper.finish();
  result.map = mapper.map("later");
  result.final_poses = mapper.finalTrajectory();
  for (const StampedPose& pose : result.final_poses) {
    const auto k = static_cast<std::size_t>(pose.t_ns / 100'000'000LL - 1);
    if (kStep * static_cast<double>(k) > mishap.at - 5.0) break;
    const Eigen::Vector2d there = (T_map_plan * poses[k]).translation();
    const Eigen::Vector2d told = SE2::fromSE3(pose.T_world_body).translation();
    result.worst_before = std::max(result.worst_before, (told - there).norm());
  }
  return result;
}

TEST(FusedRelocalisation, FindsItselfInASavedMapAndStaysThere) {
  const Plan plan = makePlan(2, 60.0, 0.4, 12);
  const SE2 T_map_plan(0.7, {-20.0, 11.0});
  const Localised later = drive(plan, testing::mapOf(plan, T_map_plan), T_map_plan, 90.0);
  std::printf("found after %.1f m; worst %.3f m, %.2f deg; NEES %.2f\n", later.found_m, later.worst,
              later.worst_yaw * 180.0 / M_PI, later.nees);
  EXPECT_GT(later.found_m, 0.0);
  EXPECT_LT(later.found_m, 30.0);
  EXPECT_LT(later.worst, 0.08);
  EXPECT_LT(later.worst_yaw, 0.01);
  EXPECT_LT(later.nees, 6.0);
  EXPECT_LT(later.height_sigma, 0.3);
  // Its own map and all of its poses, those before it was found as well, are in that map's world.
  EXPECT_THAT(findFaults(later.map), ::testing::IsEmpty());
  ASSERT_GT(later.map.slots.size(), 10U);
  for (const MapSlot& slot : later.map.slots) {
    double nearest = 1e9;
    for (const testing::PlanSlot& there : plan.slots) {
      const Eigen::Vector2d entrance = T_map_plan * (0.5 * (there.corners[0] + there.corners[1]));
      nearest = std::min(nearest, (slot.entrance() - entrance).norm());
    }
    EXPECT_LT(nearest, 0.08);
  }
  const SE2 start = T_map_plan * testing::blockDrive(60.0, 1, 0.25).front();
  const SE2 first = SE2::fromSE3(later.final_poses.front().T_world_body);
  EXPECT_LT((first.translation() - start.translation()).norm(), 0.08);
}

// Both by 6 m aside: farther than any registration searches.
TEST(FusedRelocalisation, FindsItsPlaceAgainThatTheOdometryLost) {
  const Plan plan = makePlan(2, 60.0, 0.4, 12);
  const SE2 T_map_plan(0.7, {-20.0, 11.0});
  for (const bool told : {true, false}) {
    const Mishap mishap{60.0, SE2(0.3, {1.0, 6.0}), told};
    const Localised later =
        drive(plan, testing::mapOf(plan, T_map_plan), T_map_plan, 160.0, mishap);
    std::printf("told %d: silent until %.1f m, off by %.3f m at the end\n", told,
                later.silent_after_m, later.last_off);
    EXPECT_LT(later.last_off, 0.08) << told;
    EXPECT_LT(later.silent_after_m, 110.0) << told;
    if (!told) continue;  // an odometry that is sure of itself takes what was before along
    EXPECT_GT(later.silent_after_m, 60.0);
    EXPECT_LT(later.worst_before, 0.2);
  }
}

// The second aisle is none of the map's, and looks like the first.
TEST(FusedRelocalisation, BeyondTheMapItStaysWhereItIs) {
  Plan plan = makePlan(2, 60.0, 0.4, 12);
  const auto beyond = [](const Eigen::Vector2d& p) { return p.y() > 9.0; };
  ParkingMap half = testing::mapOf(plan);
  std::erase_if(half.slots, [&](const MapSlot& slot) { return beyond(slot.entrance()); });
  std::erase_if(half.objects, [&](const MapObject& o) { return beyond(o.position.head<2>()); });
  ASSERT_GT(half.slots.size(), 10U);
  for (const SE2& pose : testing::blockDrive(60.0, 1, 0.25)) {
    if (beyond(pose.translation())) continue;
    PoseGraphNode node;
    node.id = static_cast<std::int64_t>(half.nodes.size());
    node.T_world_vehicle = pose.toSE3();
    half.nodes.push_back(node);
  }
  std::erase_if(plan.objects, [&](const testing::PlanObject& o) {
    return beyond(o.position.head<2>()) && o.semantic_class != SemanticClass::kArrow;
  });
  const Localised later = drive(plan, half, {}, 110.0);
  EXPECT_GT(later.found_m, 0.0);
  EXPECT_LT(later.worst, 0.3);
}

TEST(FusedRelocalisation, AnotherGarageIsNeverTakenForTheMap) {
  Plan other = makePlan(2, 60.0, 0.4, 13);
  for (testing::PlanObject& object : other.objects) {
    if (object.semantic_class == SemanticClass::kZoneMarker) object.text = "Z" + object.text;
  }
  const Localised later = drive(other, testing::mapOf(makePlan(2, 60.0, 0.4, 12)), {}, 60.0);
  EXPECT_EQ(later.poses, 0);
  EXPECT_FALSE(later.final_poses.empty());  // of its own world
}

}  // namespace
}  // namespace parkade
