// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/fusion/pose_filter.hpp"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/geometry/test_support.hpp"

namespace parkade {
namespace {

using Matrix4 = Eigen::Matrix4d;
constexpr double kGate = 0.9999;

TEST(ChiSquare, Quantiles) {
  EXPECT_NEAR(chiSquareQuantile(1, 0.95), 3.841, 0.005);
  EXPECT_NEAR(chiSquareQuantile(2, 0.99), 9.210, 0.005);
  EXPECT_NEAR(chiSquareQuantile(3, 0.95), 7.815, 0.06);
  EXPECT_NEAR(chiSquareQuantile(3, 0.999), 16.27, 0.35);
}

TEST(PoseFilter, ExactMeasurementsGiveTheExactPose) {
  PoseFilter filter;
  const std::int64_t anchor = filter.addAnchor();
  const Matrix4 Q = 0.01 * Matrix4::Identity();
  filter.predict(SE2(0.1, {1.0, 0.2}), 0.05, Q);
  const SE2 truth(0.15, {1.1, 0.1});
  const FilterUpdate update =
      filter.updateRelative(anchor, truth, 1e8 * Eigen::Matrix3d::Identity(), kGate);
  EXPECT_TRUE(update.accepted);
  EXPECT_LT((filter.pose().T_world_vehicle.translation() - truth.translation()).norm(), 2e-3);
  EXPECT_NEAR(filter.pose().T_world_vehicle.angle(), truth.angle(), 1e-3);
  EXPECT_LT(filter.covariance()(0, 0), 1e-7);
  EXPECT_TRUE(filter.updateHeight(anchor, 0.0, 1e-4, kGate).accepted);
  EXPECT_NEAR(filter.pose().z, 0.0, 1e-4);
}

TEST(PoseFilter, OutliersAndEmptyInformationChangeNothing) {
  PoseFilter filter;
  const std::int64_t anchor = filter.addAnchor();
  filter.predict(SE2(0.0, {1.0, 0.0}), 0.0, 1e-4 * Matrix4::Identity());
  const SE2 before = filter.pose().T_world_vehicle;
  const Matrix4 P = filter.covariance();
  const SE2 slot_further(0.0, {3.5, 0.0});
  const FilterUpdate update =
      filter.updateRelative(anchor, slot_further, 1e4 * Eigen::Matrix3d::Identity(), 0.999);
  EXPECT_FALSE(update.accepted);
  EXPECT_GT(update.distance, update.gate);
  EXPECT_FALSE(filter.updateRelative(anchor, before, Eigen::Matrix3d::Zero(), kGate).accepted);
  EXPECT_EQ(filter.pose().T_world_vehicle.translation(), before.translation());
  EXPECT_EQ(filter.covariance(), P);
}

TEST(PoseFilter, UnobservableDirectionKeepsItsUncertainty) {
  PoseFilter filter;
  const std::int64_t anchor = filter.addAnchor();
  filter.predict(SE2(0.0, {5.0, 0.0}), 0.0, 0.01 * Matrix4::Identity());
  // A lone line along x: y and the angle are measured, x is not.
  const Eigen::Matrix3d information = Eigen::Vector3d(0.0, 1e4, 1e6).asDiagonal();
  EXPECT_TRUE(filter.updateRelative(anchor, SE2(0.0, {9.0, 0.05}), information, kGate).accepted);
  EXPECT_NEAR(filter.pose().T_world_vehicle.translation().x(), 5.0, 1e-6);
  EXPECT_NEAR(filter.pose().T_world_vehicle.translation().y(), 0.05, 1e-3);
  EXPECT_NEAR(filter.covariance()(0, 0), 0.01, 1e-4);
  EXPECT_LT(filter.covariance()(1, 1), 2e-4);
}

TEST(PoseFilter, JacobiansOfTheMotionAreRight) {
  // Errors of the pose before, carried by predict(), against numbers.
  const SE2 start(0.4, {1.0, 2.0});
  const SE2 motion(0.3, {2.0, -0.5});
  const auto f = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    return ((start * motion).inverse() * (start * SE2::exp(e) * motion)).log();
  };
  const Eigen::MatrixXd numeric = testing::numericJacobian(f, Eigen::VectorXd::Zero(3));
  PoseFilter filter({start, 0.0}, Matrix4::Identity());
  filter.predict(motion, 0.0, Matrix4::Zero());
  EXPECT_THAT(filter.covariance().topLeftCorner(3, 3).eval(),
              testing::EigenMatrixNear((numeric * numeric.transpose()).eval(), 1e-6));
}

TEST(PoseFilter, RelativeCovarianceOfAFreshAnchorIsTheMotionsOwn) {
  PoseFilter filter({SE2(0.5, {3, 4}), 0.0}, 4.0 * Matrix4::Identity());
  const std::int64_t anchor = filter.addAnchor();
  const Matrix4 Q = Eigen::Vector4d(0.01, 0.02, 0.001, 0.005).asDiagonal();
  filter.predict(SE2(0.2, {5.0, 1.0}), 0.0, Q);
  EXPECT_THAT(filter.relativeCovariance(anchor), testing::EigenMatrixNear(Q, 1e-9));
  filter.removeAnchor(anchor);
  EXPECT_FALSE(filter.hasAnchor(anchor));
  EXPECT_EQ(filter.covariance().rows(), 4);
  EXPECT_THROW(static_cast<void>(filter.anchor(anchor)), CheckError);
}

// A drive twice around a block with anchors every 5 m, registrations to anchors 10 m or more back,
// and on the second lap to those of the first: the errors must be as large as the filter says.
struct Ending {
  double position_nees = 0.0;
  double yaw_nees = 0.0;
  double height_nees = 0.0;
  double error = 0.0;
  double error_odometry = 0.0;
};

Ending monteCarloDrive(std::uint64_t seed) {
  Random random(seed);
  const Eigen::Vector4d sigma_motion(0.004, 0.004, 0.0006, 0.002);
  const Eigen::Vector3d sigma_fit(0.015, 0.015, 0.001);
  const Matrix4 Q = sigma_motion.cwiseAbs2().asDiagonal();
  const Eigen::Matrix3d information = sigma_fit.cwiseAbs2().cwiseInverse().asDiagonal();
  PoseFilter filter;
  SE2 truth;
  SE2 odometry;
  double true_z = 0.0;
  struct Anchor {
    std::int64_t id;
    SE2 truth;
    double z;
    double at;
  };
  std::vector<Anchor> anchors;
  double travelled = 0.0;
  double since_fit = 0.0;
  double since_anchor = 1e9;
  constexpr double kStep = 0.5;
  constexpr double kLap = 160.0;
  while (travelled < 2.0 * kLap) {
    const double side = std::fmod(travelled, kLap / 4.0);
    const double turn = side > 30.0 ? kStep / 10.0 * M_PI / 2.0 : 0.0;
    const SE2 step = SE2::exp({kStep, 0.0, turn});
    truth = truth * step;
    const double dz = 0.01 * std::sin(travelled / 20.0);
    true_z += dz;
    Eigen::Vector4d e;
    for (int i = 0; i < 4; ++i) e[i] = sigma_motion[i] * random.normal();
    const SE2 measured = step * SE2::exp(e.head<3>());
    odometry = odometry * measured;
    filter.predict(measured, dz + e[3], Q);
    travelled += kStep;
    since_fit += kStep;
    since_anchor += kStep;
    if (since_fit >= 2.0) {
      since_fit = 0.0;
      for (const Anchor& anchor : anchors) {
        const bool overlaps = (anchor.truth.translation() - truth.translation()).norm() < 12.0;
        if (!overlaps || travelled - anchor.at < 8.0) continue;
        Eigen::Vector3d n;
        for (int i = 0; i < 3; ++i) n[i] = sigma_fit[i] * random.normal();
        const SE2 fit = anchor.truth.inverse() * truth * SE2::exp(n);
        filter.updateRelative(anchor.id, fit, information, 0.99999);
        const double height = true_z - anchor.z + 0.02 * random.normal();
        filter.updateHeight(anchor.id, height, 0.02, 0.99999);
      }
    }
    if (since_anchor >= 5.0) {
      since_anchor = 0.0;
      anchors.push_back({filter.addAnchor(), truth, true_z, travelled});
    }
  }
  const Eigen::Vector3d error = (filter.pose().T_world_vehicle.inverse() * truth).log();
  const Matrix4 P = filter.covariance();
  Ending ending;
  ending.position_nees = error.head<2>().dot(P.topLeftCorner<2, 2>().llt().solve(error.head<2>()));
  ending.yaw_nees = error.z() * error.z() / P(2, 2);
  ending.height_nees = std::pow(true_z - filter.pose().z, 2) / P(3, 3);
  ending.error = error.head<2>().norm();
  ending.error_odometry = (odometry.translation() - truth.translation()).norm();
  return ending;
}

TEST(PoseFilter, MeanNeesLiesInsideIts95PercentBand) {
  constexpr int kSeeds = 40;
  Ending mean;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Ending e = monteCarloDrive(seed);
    mean.position_nees += e.position_nees / kSeeds;
    mean.yaw_nees += e.yaw_nees / kSeeds;
    mean.height_nees += e.height_nees / kSeeds;
    mean.error += e.error / kSeeds;
    mean.error_odometry += e.error_odometry / kSeeds;
  }
  const auto low = [](int n) { return chiSquareQuantile(n * kSeeds, 0.025) / kSeeds; };
  const auto high = [](int n) { return chiSquareQuantile(n * kSeeds, 0.975) / kSeeds; };
  std::printf(
      "mean NEES over %d seeds: position %.2f in [%.2f, %.2f], yaw %.2f and height %.2f in "
      "[%.2f, %.2f]; mean error %.3f m, odometry alone %.3f m\n",
      kSeeds, mean.position_nees, low(2), high(2), mean.yaw_nees, mean.height_nees, low(1), high(1),
      mean.error, mean.error_odometry);
  EXPECT_GT(mean.position_nees, low(2));
  EXPECT_LT(mean.position_nees, high(2));
  EXPECT_GT(mean.yaw_nees, low(1));
  EXPECT_LT(mean.yaw_nees, high(1));
  EXPECT_GT(mean.height_nees, low(1));
  EXPECT_LT(mean.height_nees, high(1));
  EXPECT_LT(mean.error, 0.5 * mean.error_odometry);
}

// Axes that are read off wrongly by the same angle all the time: the heading stops drifting, and
// the filter does not get surer than that angle allows.
TEST(PoseFilter, HeadingReferenceStopsTheDriftAndKeepsItsOwnError) {
  constexpr int kSeeds = 40;
  constexpr double kReference = 2e-3;
  constexpr double kReading = 4e-3;
  constexpr double kDrift = 1e-3;  // per step
  double nees = 0.0;
  double square = 0.0;
  double sigma = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Random random(seed);
    PoseFilter filter;
    double truth = 0.0;
    const std::int64_t reference = filter.addHeadingReference(kReference);
    const double bias = kReference * random.normal();
    for (int k = 0; k < 300; ++k) {
      const double turn = 0.01 * std::sin(0.05 * k);
      truth += turn;
      filter.predict(SE2(turn + kDrift * random.normal(), {0.1, 0.0}), 0.0,
                     Eigen::Vector4d(1e-8, 1e-8, kDrift * kDrift, 1e-8).asDiagonal());
      filter.updateTurn(reference, truth + bias + kReading * random.normal(), kReading, 0.99999);
    }
    const double error = filter.pose().T_world_vehicle.angle() - truth;
    nees += error * error / filter.covariance()(2, 2) / kSeeds;
    square += error * error / kSeeds;
    sigma = std::sqrt(filter.covariance()(2, 2));
  }
  std::printf("heading by axes: error %.5f, sigma %.5f, NEES %.2f\n", std::sqrt(square), sigma,
              nees);
  EXPECT_GT(nees, chiSquareQuantile(kSeeds, 0.025) / kSeeds);
  EXPECT_LT(nees, chiSquareQuantile(kSeeds, 0.975) / kSeeds);
  EXPECT_LT(std::sqrt(square), 0.3 * kDrift * std::sqrt(300.0));
  EXPECT_GT(sigma, 0.3 * kReference);
}

TEST(PoseFilter, APlaceTellsWhereTheWorldLiesAndRebasingChangesNoError) {
  PoseFilter filter({SE2(0.3, {1.0, 2.0}), 0.0}, 1e-6 * Eigen::Matrix4d::Identity());
  filter.predict(SE2(0.1, {4.0, 0.0}), 0.0, 1e-4 * Eigen::Matrix4d::Identity());
  const std::int64_t seen_from = filter.addAnchor();
  const SE2 T_place_car(-1.2, {20.0, -7.0});
  // Linear only about where it is.
  const SE2 T_world_place = filter.pose().T_world_vehicle * T_place_car.inverse();
  const std::int64_t place =
      filter.addPlace({T_world_place, 0.0}, 100.0 * Eigen::Matrix4d::Identity());
  const Eigen::Matrix3d information = 1e4 * Eigen::Matrix3d::Identity();
  ASSERT_TRUE(filter.updateBetween(place, seen_from, T_place_car, information, 0.999).accepted);
  const Eigen::Matrix4d before = filter.relativeCovariance(place);
  EXPECT_NEAR(before(0, 0), 1e-4, 2e-6);  // the measurement's own
  filter.rebase(filter.anchor(place).T_world_vehicle.inverse(), 0.5);
  EXPECT_LT(filter.anchor(place).T_world_vehicle.log().norm(), 1e-12);
  EXPECT_LT((filter.pose().T_world_vehicle.inverse() * T_place_car).log().norm(), 1e-3);
  EXPECT_DOUBLE_EQ(filter.pose().z, 0.5);
  EXPECT_LT((filter.relativeCovariance(place) - before).norm(), 1e-12);
}

TEST(PoseFilter, CovarianceStaysSymmetricAndPositive) {
  PoseFilter filter;
  Random random(9);
  std::vector<std::int64_t> anchors;
  for (int k = 0; k < 300; ++k) {
    filter.predict(SE2::exp({0.5, 0.0, 0.05}), 0.0,
                   Eigen::Vector4d(1e-4, 1e-4, 1e-6, 1e-5).asDiagonal());
    if (k % 10 == 0) anchors.push_back(filter.addAnchor());
    if (anchors.size() > 20) {
      filter.removeAnchor(anchors.front());
      anchors.erase(anchors.begin());
    }
    const SE2 T = filter.anchor(anchors.front()).T_world_vehicle.inverse() *
                  filter.pose().T_world_vehicle * SE2::exp({0.01 * random.normal(), 0.0, 0.0});
    filter.updateRelative(anchors.front(), T, 1e6 * Eigen::Matrix3d::Identity(), 0.99999);
  }
  const Matrix4 P = filter.covariance();
  EXPECT_EQ(P, P.transpose());
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix4>(P).eigenvalues().minCoeff(), 0.0);
}

}  // namespace
}  // namespace parkade
