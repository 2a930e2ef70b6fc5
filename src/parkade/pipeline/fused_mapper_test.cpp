// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/fused_mapper.hpp"

#include <gmock/gmock.h>

#include <set>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/synthetic_plan.hpp"

namespace parkade {
namespace {

using testing::makePlan;
using testing::ObserverNoise;
using testing::Plan;
using testing::PlanObserver;
using testing::PlanSlot;

constexpr double kDegree = M_PI / 180.0;

struct DriveOptions {
  double scale_error = 0.004;  // the odometry's metres are too long
  double yaw_per_m = 0.02;     // deg/m, constant
  double noise_m = 0.004;      // per square root of a metre
  double noise_deg = 0.02;
  int laps = 2;
  bool labels = false;
  double blind_from = 1e9;  // no features between these ways, m
  double blind_to = 1e9;
  double poseless_from = 1e9;  // the odometry starts again between these ways, m
  double poseless_to = 1e9;
  double cameras_turned_deg = 0.0;  // and taken for straight; learned between 30 and 60 m
  bool tell_what_is_learned = true;
};

struct DriveResult {
  double odometry_rmse = 0.0;
  double fused_rmse = 0.0;
  double fused_yaw_rmse = 0.0;
  double fused_worst = 0.0;
  double nees = 0.0;
  FusedMapperStatistics statistics;
  ParkingMap map;
  SE2 T_world_map;
};

ObserverNoise usualNoise() {
  ObserverNoise noise;
  noise.line_sigma = 0.015;
  noise.corner_sigma = 0.03;
  noise.object_sigma = 0.05;
  noise.attitude_sigma = 0.1 * kDegree;
  noise.dropout = 0.2;
  noise.outliers = 0.05;
  noise.label_noise = 0.02;
  return noise;
}

// rad: how far the cameras are taken to be turned too far after so much of the way.
double turnedTooFar(const DriveOptions& options, double way) {
  return kDegree * options.cameras_turned_deg * std::clamp((60.0 - way) / 30.0, 0.0, 1.0);
}

// What such cameras see of the plan.
SemanticFrame look(const PlanObserver& observer, TimeNs t_ns, const SE2& pose, double way,
                   const DriveOptions& options, Random& random) {
  const double turned = turnedTooFar(options, way);
  SemanticFrame frame =
      observer.observe(t_ns, pose * SE2(-turned, {0.0, 0.0}), random, options.labels);
  if (options.tell_what_is_learned) frame.rig_turn = turned - turnedTooFar(options, 0.0);
  return frame;
}

DriveResult drive(const Plan& plan, const DriveOptions& options, std::uint64_t seed) {
  const PlanObserver observer(plan, usualNoise());
  // As bad as this odometry is; the defaults are for a better one.
  FusedMapperOptions fusion;
  fusion.odometry.translation = 0.02;
  fusion.odometry.yaw_deg = 0.05;
  fusion.compass.sigma_deg = 0.5;
  fusion.submaps.sigma_m = 0.01;
  fusion.submaps.sigma_deg = 0.05;
  FusedMapper mapper(fusion, {});
  Random random(seed);
  constexpr double kStep = 0.25;
  const std::vector<SE2> poses = testing::blockDrive(60.0, options.laps, kStep);
  const SE2 T_start = poses.front();
  SE2 odometry;
  DriveResult result;
  result.T_world_map = T_start;
  double way = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const TimeNs t_ns = 100'000'000LL * static_cast<TimeNs>(k + 1);
    if (k > 0) {
      const Eigen::Vector3d d = (poses[k - 1].inverse() * poses[k]).log();
      const double root = std::sqrt(kStep);
      const double turned = turnedTooFar(options, way);
      odometry =
          odometry *
          SE2::exp({d.x() * (1.0 + options.scale_error) + options.noise_m * root * random.normal(),
                    d.y() + d.x() * turned + options.noise_m * root * random.normal(),
                    d.z() + kDegree * (options.yaw_per_m * kStep +
                                       options.noise_deg * root * random.normal())});
      way += kStep;
    }
    PoseEstimate vio;
    vio.t_ns = t_ns;
    vio.T_odom_vehicle = odometry.toSE3();
    vio.health = Health::kTracking;
    if (way >= options.poseless_from && way <= options.poseless_to) {
      vio.health = Health::kInitialising;
      vio.T_odom_vehicle = SE3();
      EXPECT_EQ(mapper.addOdometry(vio).health, Health::kInitialising);
      continue;
    }
    PoseEstimate fused = mapper.addOdometry(vio);
    if (way < options.blind_from || way > options.blind_to) {
      fused = mapper.addSemantics(look(observer, t_ns, poses[k], way, options, random), {});
    }
    const SE2 truth = T_start.inverse() * poses[k];
    const SE2 estimate = SE2::fromSE3(fused.T_odom_vehicle);
    const double error = (estimate.translation() - truth.translation()).norm();
    result.fused_rmse += error * error / static_cast<double>(poses.size());
    result.fused_worst = std::max(result.fused_worst, error);
    result.odometry_rmse += (odometry.translation() - truth.translation()).squaredNorm() /
                            static_cast<double>(poses.size());
    const double yaw = wrapAngle(estimate.angle() - truth.angle());
    result.fused_yaw_rmse += yaw * yaw / static_cast<double>(poses.size());
    if (k + 1 == poses.size()) {
      const Eigen::Vector3d e = (estimate.inverse() * truth).log();
      const Eigen::Matrix2d P = fused.covariance.topLeftCorner<2, 2>();
      result.nees = e.head<2>().dot(P.inverse() * e.head<2>());
    }
  }
  mapper.finish();
  result.fused_rmse = std::sqrt(result.fused_rmse);
  result.odometry_rmse = std::sqrt(result.odometry_rmse);
  result.fused_yaw_rmse = std::sqrt(result.fused_yaw_rmse);
  result.statistics = mapper.statistics();
  result.map = mapper.map("synthetic");
  return result;
}

// A rig told wrong turns its pictures until that is learned; the heading must not follow them.
TEST(FusedMapper, CamerasThatAreLearnedToBeTurnedDoNotTurnTheHeading) {
  DriveOptions options;
  options.cameras_turned_deg = 0.5;
  options.yaw_per_m = 0.005;
  const Plan plan = makePlan(2, 60.0, 0.6, 1);
  const double told = drive(plan, options, 1).fused_yaw_rmse;
  options.tell_what_is_learned = false;
  const double silent = drive(plan, options, 1).fused_yaw_rmse;
  std::printf("heading off by %.3f deg, by %.3f where it is not told what cameras learned\n",
              told / kDegree, silent / kDegree);
  EXPECT_LT(told, 0.6 * silent);
}

TEST(FusedMapper, IsMuchBetterThanItsOdometryAndHonest) {
  double fused = 0.0;
  double odometry = 0.0;
  double nees = 0.0;
  constexpr int kSeeds = 3;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    DriveOptions options;
    Random random(seed);
    options.scale_error = random.uniform(-0.005, 0.005);
    options.yaw_per_m = random.uniform(-0.02, 0.02);
    const DriveResult r = drive(makePlan(2, 60.0, 0.6, seed), options, seed);
    const FusedMapperStatistics& n = r.statistics;
    std::printf("seed %d: odometry %.3f m, fused %.3f m (worst %.3f, yaw %.3f deg), NEES %.2f\n",
                static_cast<int>(seed), r.odometry_rmse, r.fused_rmse, r.fused_worst,
                r.fused_yaw_rmse / kDegree, r.nees);
    std::printf("  %d of %d registrations, %d of %d revisits, %d headings, %d gated\n", n.accepted,
                n.registrations, n.loops, n.revisits, n.headings, n.refused_by_gate);
    EXPECT_LE(r.fused_rmse, r.odometry_rmse) << seed;
    EXPECT_GT(r.statistics.loops, 5) << seed;
    fused += r.fused_rmse / kSeeds;
    odometry += r.odometry_rmse / kSeeds;
    nees += r.nees / kSeeds;
  }
  EXPECT_LT(fused, 0.4 * odometry);
  EXPECT_LT(nees, 2.0 * 3.0);
}

TEST(FusedMapper, MapHasEverySlotOnceAndFollowsTheCorrections) {
  const Plan plan = makePlan(2, 60.0, 0.6, 3);
  DriveOptions options;
  options.labels = true;
  options.laps = 1;
  options.scale_error = 0.002;
  options.yaw_per_m = 0.005;
  const DriveResult r = drive(plan, options, 3);
  EXPECT_TRUE(findFaults(r.map).empty());
  std::set<const PlanSlot*> found;
  std::vector<double> errors;
  for (const MapSlot& slot : r.map.slots) {
    const PlanSlot* best = nullptr;
    double distance = 1.0;
    for (const PlanSlot& truth : plan.slots) {
      const double d = 0.5 * ((r.T_world_map * slot.corners[0] - truth.corners[0]).norm() +
                              (r.T_world_map * slot.corners[1] - truth.corners[1]).norm());
      if (d >= distance) continue;
      distance = d;
      best = &truth;
    }
    ASSERT_NE(best, nullptr);
    EXPECT_TRUE(found.insert(best).second) << best->number;
    errors.push_back(distance);
  }
  ASSERT_GT(errors.size(), 40U);
  std::sort(errors.begin(), errors.end());
  std::printf("%zu slots, corner error median %.3f m, worst %.3f m\n", errors.size(),
              errors[errors.size() / 2], errors.back());
  EXPECT_LT(errors[errors.size() / 2], 0.15);
  EXPECT_TRUE(r.map.grid.bounds().has_value());
}

TEST(FusedMapper, ALongStandCountsAsAFewLooks) {
  const PlanObserver observer(makePlan(1, 40.0, 0.5, 6), {});
  FusedMapper mapper({}, {});
  Random random(1);
  for (int k = 0; k < 30; ++k) {
    PoseEstimate vio;
    vio.t_ns = 500'000'000LL * (k + 1);
    vio.health = Health::kTracking;
    mapper.addOdometry(vio);
    mapper.addSemantics(observer.observe(vio.t_ns, SE2(0.0, {20.0, 0.0}), random, false), {});
  }
  const ParkingMap map = mapper.map("standing");
  ASSERT_FALSE(map.slots.empty());
  for (const MapSlot& slot : map.slots) {
    EXPECT_LE(slot.observations, 5);
    EXPECT_EQ(slot.last_seen_ns, 15'000'000'000LL);
  }
  for (const MapObject& object : map.objects) {
    // Zone markers are told by views of their own.
    if (object.semantic_class == SemanticClass::kZoneMarker) continue;
    EXPECT_LE(object.observations, 5);
  }
}

TEST(FusedMapper, SecondsWithoutFeaturesAreSurvived) {
  DriveOptions options;
  options.blind_from = 60.0;
  options.blind_to = 90.0;
  const DriveResult r = drive(makePlan(2, 60.0, 0.6, 4), options, 4);
  EXPECT_LE(r.fused_rmse, r.odometry_rmse);
  EXPECT_GT(r.statistics.loops, 5);
}

TEST(FusedMapper, GoesOnWhereTheOdometryStartsAgain) {
  DriveOptions options;
  options.poseless_from = 70.0;
  options.poseless_to = 71.0;
  const DriveResult r = drive(makePlan(2, 60.0, 0.6, 4), options, 4);
  EXPECT_LE(r.fused_rmse, r.odometry_rmse);
  EXPECT_LT(r.fused_worst, 1.0);
  EXPECT_GT(r.statistics.loops, 5);
  EXPECT_TRUE(findFaults(r.map).empty());
}

TEST(FusedMapper, SameCallsGiveTheSameBytes) {
  DriveOptions options;
  options.laps = 1;
  options.labels = true;
  const Plan plan = makePlan(2, 60.0, 0.6, 5);
  const DriveResult a = drive(plan, options, 5);
  const DriveResult b = drive(plan, options, 5);
  EXPECT_EQ(a.fused_rmse, b.fused_rmse);
  EXPECT_GT(a.map.slots.size(), 40U);
  EXPECT_FALSE(a.map.grid.tiles(GridLayer::kParkingLines).empty());
  EXPECT_TRUE(a.map.slots == b.map.slots);
  EXPECT_TRUE(a.map.grid == b.map.grid);
  EXPECT_TRUE(a.map.objects == b.map.objects);
}

}  // namespace
}  // namespace parkade
