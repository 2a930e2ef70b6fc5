// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "parkade/core/random.hpp"
#include "parkade/geometry/test_support.hpp"
#include "parkade/vio/factors.hpp"
#include "parkade/vio/reprojection.hpp"
#include "parkade/vio/track_simulator.hpp"

namespace parkade {
namespace {

using Eigen::Vector3d;
using testing::EigenMatrixNear;
using testing::numericJacobian;

Vector3d draw(Random& random, double scale) {
  return scale * Vector3d(random.normal(), random.normal(), random.normal());
}

WindowFrame drawFrame(Random& random, int id) {
  WindowFrame frame;
  frame.id = id;
  frame.state = {SO3::exp(draw(random, 0.4)), draw(random, 2.0), draw(random, 1.0)};
  frame.bias = {draw(random, 0.02), draw(random, 0.1)};
  frame.gyro = draw(random, 0.3);
  return frame;
}

WindowFrame moved(WindowFrame frame, const Eigen::VectorXd& step) {
  frame.apply(step);
  return frame;
}

class ReprojectionJacobian : public ::testing::TestWithParam<int> {};

TEST_P(ReprojectionJacobian, IsThatOfFiniteDifferences) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  VioCamera anchor_camera;
  VioCamera target_camera;
  PinholeEquidistant::Parameters wide;
  wide.fx = wide.fy = 200.0;
  wide.k1 = 0.02;
  PinholeRadtan::Parameters narrow;
  narrow.fx = 300.0;
  narrow.fy = 310.0;
  narrow.distortion.k1 = -0.1;
  anchor_camera.camera = Camera(PinholeEquidistant(wide), 640, 400);
  target_camera.camera = Camera(PinholeRadtan(narrow), 640, 400);
  anchor_camera.T_imu_cam = SE3(SO3::exp(draw(random, 0.2)), draw(random, 0.3));
  target_camera.T_imu_cam = SE3(SO3::exp(draw(random, 0.2)), draw(random, 0.3));
  NavState anchor;
  anchor.R_odom_imu = SO3::exp(draw(random, 0.1));
  NavState target;
  target.R_odom_imu = SO3::exp(draw(random, 0.1));
  target.p_odom = draw(random, 0.3);
  const Vector3d direction = (Vector3d::UnitZ() + draw(random, 0.15)).normalized();
  const double rho = GetParam() == 0 ? 1e-4 : 0.2;

  const auto pixelAt = [&](const Eigen::VectorXd& x) {
    const PoseMatrices a(
        SE3(anchor.R_odom_imu * SO3::exp(x.segment<3>(3)), anchor.p_odom + x.segment<3>(0)));
    const PoseMatrices t(
        SE3(target.R_odom_imu * SO3::exp(x.segment<3>(9)), target.p_odom + x.segment<3>(6)));
    const Vector3d d =
        (direction + tangentBasis(direction) * Eigen::Vector2d(x(12), x(13))).normalized();
    Eigen::Vector2d pixel;
    EXPECT_TRUE(reproject(anchor_camera, target_camera, target_camera.T_imu_cam, a, t, a, t, d,
                          rho + x(14), pixel));
    return Eigen::VectorXd(pixel);
  };
  const PoseMatrices a(anchor);
  const PoseMatrices t(target);
  Eigen::Vector2d pixel;
  ReprojectionJacobians j;
  ASSERT_TRUE(reproject(anchor_camera, target_camera, target_camera.T_imu_cam, a, t, a, t,
                        direction, rho, pixel, &j));
  Eigen::MatrixXd analytic(2, 15);
  analytic << j.d_px_d_anchor, j.d_px_d_target, j.d_px_d_landmark;
  EXPECT_THAT(analytic, EigenMatrixNear(numericJacobian(pixelAt, Eigen::VectorXd::Zero(15)), 2e-5));
}

TEST_P(ReprojectionJacobian, ByTheCamerasIsThatOfFiniteDifferences) {
  Random random(static_cast<std::uint64_t>(GetParam()) + 100);
  VioCamera anchor_camera;
  VioCamera target_camera;
  PinholeEquidistant::Parameters wide;
  wide.fx = wide.fy = 200.0;
  wide.k1 = 0.02;
  anchor_camera.camera = target_camera.camera = Camera(PinholeEquidistant(wide), 640, 400);
  anchor_camera.T_imu_cam = SE3(SO3::exp(draw(random, 0.2)), draw(random, 0.3));
  target_camera.T_imu_cam = SE3(SO3::exp(draw(random, 0.2)), draw(random, 0.3));
  NavState state;
  const PoseMatrices a(state);
  state.p_odom = draw(random, 0.3);
  state.R_odom_imu = SO3::exp(draw(random, 0.1));
  const PoseMatrices t(state);
  const Vector3d direction = (Vector3d::UnitZ() + draw(random, 0.15)).normalized();
  const auto moved_camera = [](VioCamera camera, const Eigen::VectorXd& x) {
    camera.T_imu_cam = SE3(camera.T_imu_cam.rotation() * SO3::exp(x.tail<3>()),
                           camera.T_imu_cam.translation() + x.head<3>());
    return camera;
  };
  const auto pixelAt = [&](const Eigen::VectorXd& x) {
    Eigen::Vector2d pixel;
    const VioCamera moved_target = moved_camera(target_camera, x.tail<6>());
    EXPECT_TRUE(reproject(moved_camera(anchor_camera, x.head<6>()), moved_target,
                          moved_target.T_imu_cam, a, t, a, t, direction, 0.2, pixel));
    return Eigen::VectorXd(pixel);
  };
  Eigen::Vector2d pixel;
  ReprojectionJacobians j;
  CameraJacobians cameras;
  ASSERT_TRUE(reproject(anchor_camera, target_camera, target_camera.T_imu_cam, a, t, a, t,
                        direction, 0.2, pixel, &j, &cameras));
  Eigen::MatrixXd analytic(2, 12);
  analytic << cameras.d_px_d_anchor_camera, cameras.d_px_d_target_camera;
  EXPECT_THAT(analytic, EigenMatrixNear(numericJacobian(pixelAt, Eigen::VectorXd::Zero(12)), 2e-5));
}

INSTANTIATE_TEST_SUITE_P(Seeds, ReprojectionJacobian, ::testing::Range(0, 6));

TEST(ReprojectionJacobian, FirstEstimatesLeaveACommonMotionWithoutEffect) {
  Random random(9);
  VioCamera camera;
  PinholeRadtan::Parameters p;
  p.fx = p.fy = 300.0;
  camera.camera = Camera(PinholeRadtan(p), 640, 400);
  NavState anchor_lin;
  NavState target_lin;
  target_lin.R_odom_imu = SO3::exp(draw(random, 0.1));
  target_lin.p_odom = draw(random, 0.5);
  // The present states have moved on from where they were linearised.
  NavState target = target_lin;
  target.p_odom += draw(random, 0.2);
  target.R_odom_imu = target.R_odom_imu * SO3::exp(draw(random, 0.05));
  Eigen::Vector2d pixel;
  ReprojectionJacobians j;
  ASSERT_TRUE(reproject(camera, camera, camera.T_imu_cam, PoseMatrices(anchor_lin),
                        PoseMatrices(target), PoseMatrices(anchor_lin), PoseMatrices(target_lin),
                        Vector3d(0.1, -0.05, 1.0).normalized(), 0.3, pixel, &j));
  // A turn about the vertical through the origin moves positions and turns the bodies.
  const Vector3d up = Vector3d::UnitZ();
  Eigen::Matrix<double, 6, 4> anchor_gauge = Eigen::Matrix<double, 6, 4>::Zero();
  Eigen::Matrix<double, 6, 4> target_gauge = anchor_gauge;
  anchor_gauge.topLeftCorner<3, 3>().setIdentity();
  target_gauge.topLeftCorner<3, 3>().setIdentity();
  anchor_gauge.col(3) << up.cross(anchor_lin.p_odom), anchor_lin.R_odom_imu.inverse() * up;
  target_gauge.col(3) << up.cross(target_lin.p_odom), target_lin.R_odom_imu.inverse() * up;
  const Eigen::MatrixXd effect = j.d_px_d_anchor * anchor_gauge + j.d_px_d_target * target_gauge;
  EXPECT_LT(effect.cwiseAbs().maxCoeff(), 1e-9);
}

TEST(FactorJacobian, ImuIsThatOfFiniteDifferences) {
  Random random(4);
  const WindowFrame begin = drawFrame(random, 0);
  WindowFrame end = drawFrame(random, 1);
  Preintegration sum(ImuNoise{}, begin.bias);
  for (int i = 0; i < 20; ++i) {
    sum.integrate(
        {i * 5 * kNsPerMs, draw(random, 0.2), draw(random, 0.2) + Vector3d(0, 0, 9.8)},
        {(i + 1) * 5 * kNsPerMs, draw(random, 0.2), draw(random, 0.2) + Vector3d(0, 0, 9.8)},
        kNsPerSecond);
  }
  end.imu = sum;
  end.imu_sqrt_information = Matrix15d::Identity();
  WindowGravity gravity;
  gravity.apply({0.02, -0.03});
  Matrix15d by_begin;
  Matrix15d by_end;
  Matrix15x2d by_gravity;
  (void)imuResidual(begin, end, gravity, &by_begin, &by_end, &by_gravity);
  const auto pulled = [&](const Eigen::VectorXd& x) {
    WindowGravity other = gravity;
    other.apply(x);
    return Eigen::VectorXd(imuResidual(begin, end, other));
  };
  EXPECT_THAT(by_gravity, EigenMatrixNear(numericJacobian(pulled, Eigen::VectorXd::Zero(2)), 1e-6));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(15);
  EXPECT_THAT(by_begin, EigenMatrixNear(numericJacobian(
                                            [&](const Eigen::VectorXd& x) {
                                              return Eigen::VectorXd(
                                                  imuResidual(moved(begin, x), end, gravity));
                                            },
                                            zero),
                                        1e-6));
  EXPECT_THAT(by_end, EigenMatrixNear(numericJacobian(
                                          [&](const Eigen::VectorXd& x) {
                                            return Eigen::VectorXd(
                                                imuResidual(begin, moved(end, x), gravity));
                                          },
                                          zero),
                                      1e-6));
}

TEST(FactorJacobian, RestSpeedAndStartAreThoseOfFiniteDifferences) {
  Random random(5);
  const WindowFrame rest = drawFrame(random, 0);
  WindowFrame now = drawFrame(random, 1);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(15);
  const StillSigma sigma{0.1, 0.2, 0.3};
  Matrix9x15d by_rest;
  Matrix9x15d by_now;
  (void)stillResidual(rest, now, sigma, &by_rest, &by_now);
  EXPECT_THAT(by_rest, EigenMatrixNear(numericJacobian(
                                           [&](const Eigen::VectorXd& x) {
                                             return Eigen::VectorXd(
                                                 stillResidual(moved(rest, x), now, sigma));
                                           },
                                           zero),
                                       1e-6));
  EXPECT_THAT(by_now, EigenMatrixNear(numericJacobian(
                                          [&](const Eigen::VectorXd& x) {
                                            return Eigen::VectorXd(
                                                stillResidual(rest, moved(now, x), sigma));
                                          },
                                          zero),
                                      1e-6));

  const SE3 T_imu_vehicle(SO3::exp(draw(random, 0.2)), draw(random, 0.5));
  now.body_velocity = Vector3d(2.0, 0.0, 0.0);
  now.body_velocity_sigma = Vector3d(0.05, 0.1, 0.0);
  Matrix3x15d by_frame;
  (void)bodyVelocityResidual(now, T_imu_vehicle, &by_frame);
  EXPECT_THAT(by_frame, EigenMatrixNear(numericJacobian(
                                            [&](const Eigen::VectorXd& x) {
                                              return Eigen::VectorXd(bodyVelocityResidual(
                                                  moved(now, x), T_imu_vehicle));
                                            },
                                            zero),
                                        1e-6));
  EXPECT_EQ(by_frame.row(2).norm(), 0.0);

  WindowGravity gravity;
  gravity.apply({0.02, -0.03});
  StartPrior prior;
  prior.gravity_sigma = 0.01;
  Eigen::Matrix2d by_gravity;
  (void)gravityResidual(gravity, prior, &by_gravity);
  const auto tilted = [&](const Eigen::VectorXd& x) {
    WindowGravity other = gravity;
    other.apply(x);
    return Eigen::VectorXd(gravityResidual(other, prior));
  };
  EXPECT_THAT(by_gravity, EigenMatrixNear(numericJacobian(tilted, Eigen::VectorXd::Zero(2)), 1e-6));

  prior.state = rest.state;
  prior.sigma.setConstant(0.5);
  prior.sigma(7) = 0.0;
  Matrix15d by_start;
  (void)startResidual(now, prior, &by_start);
  EXPECT_THAT(by_start,
              EigenMatrixNear(numericJacobian(
                                  [&](const Eigen::VectorXd& x) {
                                    return Eigen::VectorXd(startResidual(moved(now, x), prior));
                                  },
                                  zero),
                              1e-6));
}

TEST(FactorJacobian, ImuFirstEstimatesLeaveACommonMotionWithoutEffect) {
  Random random(11);
  WindowFrame begin = drawFrame(random, 0);
  WindowFrame end = drawFrame(random, 1);
  WindowGravity gravity;
  Preintegration sum(ImuNoise{}, begin.bias);
  for (int i = 0; i < 40; ++i) {
    sum.integrate(
        {i * 5 * kNsPerMs, draw(random, 0.2), draw(random, 0.2) + Vector3d(0, 0, 9.8)},
        {(i + 1) * 5 * kNsPerMs, draw(random, 0.2), draw(random, 0.2) + Vector3d(0, 0, 9.8)},
        kNsPerSecond);
  }
  // The first estimates fit the readings, as those of a solved window do.
  end.state = sum.propagate(begin.state, begin.bias, gravity.vector);
  end.bias = begin.bias;
  end.imu = sum;
  end.imu_sqrt_information = Matrix15d::Identity();
  begin.fixLinearisation();
  end.fixLinearisation();
  gravity.fixLinearisation();
  // The present states have moved on.
  begin.apply(0.01 * Vector15d::Ones());
  end.apply(-0.01 * Vector15d::Ones());
  gravity.apply({0.01, 0.02});
  Matrix15d by_begin;
  Matrix15d by_end;
  Matrix15x2d by_gravity;
  (void)imuResidual(begin, end, gravity, &by_begin, &by_end, &by_gravity);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d n = Vector3d::Unit(axis);
    const auto turned = [&](const NavState& lin) {
      Vector15d d = Vector15d::Zero();
      d.segment<3>(0) = n.cross(lin.p_odom);
      d.segment<3>(3) = lin.R_odom_imu.inverse() * n;
      d.segment<3>(6) = n.cross(lin.v_odom);
      return d;
    };
    // The step on the sphere that turns gravity about n.
    const Eigen::Vector2d pull = gravity.basis().transpose() * n.cross(gravity.lin_vector) /
                                 gravity.lin_vector.squaredNorm();
    const Vector15d effect =
        by_begin * turned(begin.lin_state) + by_end * turned(end.lin_state) + by_gravity * pull;
    EXPECT_LT(effect.norm(), 1e-9) << axis;
  }
}

TEST(TangentBasis, IsAcrossTheDirectionEverywhere) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const Vector3d d = i == 0 ? Vector3d(-Vector3d::UnitZ()) : draw(random, 1.0).normalized();
    const Eigen::Matrix<double, 3, 2> basis = tangentBasis(d);
    EXPECT_LT((basis.transpose() * d).norm(), 1e-12);
    EXPECT_THAT(Eigen::Matrix2d(basis.transpose() * basis),
                EigenMatrixNear(Eigen::Matrix2d::Identity(), 1e-12));
  }
}

}  // namespace
}  // namespace parkade
