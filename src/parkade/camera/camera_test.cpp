// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/camera/camera.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"

namespace parkade {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

RadtanDistortion radtan(double k1, double k2, double p1, double p2) {
  RadtanDistortion distortion;
  distortion.k1 = k1;
  distortion.k2 = k2;
  distortion.p1 = p1;
  distortion.p2 = p2;
  return distortion;
}

// EuRoC MAV, cam0.
Camera euroc() {
  PinholeRadtan::Parameters p{458.654, 457.296, 367.215, 248.375, {}};
  p.distortion = radtan(-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05);
  return {PinholeRadtan(p), 752, 480};
}

Camera plainPinhole() {
  return {PinholeRadtan({400.0, 410.0, 319.5, 199.5, {}}), 640, 400};
}

Camera rational() {
  PinholeRadtan::Parameters p{500.0, 500.0, 639.5, 359.5, {}};
  p.distortion = {0.9, 0.13, 1e-4, -2e-4, 0.004, 1.2, 0.35, 0.03};
  return {PinholeRadtan(p), 1280, 720};
}

// A lens whose distortion folds back inside the image.
Camera foldingPinhole() {
  PinholeRadtan::Parameters p{300.0, 300.0, 319.5, 239.5, {}};
  p.distortion = radtan(-0.4, 0.05, 2e-3, -1e-3);
  return {PinholeRadtan(p), 640, 480};
}

// ROECS (a real surround-view set), front.
Camera roecs() {
  return {PinholeEquidistant({422.13163849, 421.10340889, 612.82890504, 545.05656249, -0.07031853,
                              0.00387505, -0.00333139, 0.00056406}),
          1280, 1080};
}

// Reaches beyond 90 degrees at the image border.
Camera wideFisheye() {
  return {PinholeEquidistant({318.0, 318.0, 639.5, 479.5, 0.12, -0.02, 0.003, -0.0001}), 1280, 960};
}

Camera omni() {
  Mei::Parameters p{1.9, 1500.0, 1498.0, 655.2, 511.7, {}};
  p.distortion = radtan(-0.18, 0.9, 1e-3, -2e-3);
  return {Mei(p), 1280, 1024};
}

Camera stereographic() {
  return {Mei({1.0, 935.307436087, 935.307436087, 960.0, 540.0, {}}), 1920, 1080};
}

Camera perspectiveMei() {
  return {Mei({0.0, 400.0, 410.0, 319.5, 199.5, {}}), 640, 400};
}

Camera mildOmni() {
  Mei::Parameters p{0.8, 500.0, 505.0, 320.0, 241.0, {}};
  p.distortion = radtan(-0.05, 0.01, -5e-4, 3e-4);
  return {Mei(p), 640, 480};
}

// A real fisheye in an underground car park, front.
Ocam::Parameters ocamParameters() {
  Ocam::Parameters p;
  p.world2cam = {627.927477776227, 466.028077028629,  -2.8986629308847,  24.2220612718414,
                 72.6950631423446, -33.3800489422008, -23.5185216191834, 114.225279210139,
                 139.347809599797, 61.1223487329993,  9.684055492906211};
  p.affine << 0.999838380441138, 0.0004930391795583601, 0.0002399186063006992, 1.0;
  p.cx = 648.5992811830847;
  p.cy = 481.3627675101494;
  return p;
}

Camera ocam() {
  return {Ocam(ocamParameters()), 1280, 960};
}

// The same with a (coarse) backward polynomial, which must change nothing but the start.
Camera ocamWithBackward() {
  Ocam::Parameters p = ocamParameters();
  p.cam2world = {-318.5, 0.0, 7.3e-4, -2e-7, 4e-10};
  return {Ocam(p), 1280, 960};
}

struct Named {
  const char* name;
  Camera (*make)();
  bool whole_image;  // every pixel of the image has a ray
};

std::ostream& operator<<(std::ostream& stream, const Named& named) {
  return stream << named.name;
}

class EveryModel : public testing::TestWithParam<Named> {
 protected:
  Camera camera_ = GetParam().make();
};

TEST_P(EveryModel, PixelsComeBackWithinAMillionthPixel) {
  int valid = 0;
  int all = 0;
  double worst = 0.0;
  for (double v = -0.5; v <= camera_.height() - 0.5; v += 7.75) {
    for (double u = -0.5; u <= camera_.width() - 0.5; u += 7.75) {
      ++all;
      Eigen::Vector3d ray;
      if (!camera_.unproject({u, v}, ray)) continue;
      ++valid;
      EXPECT_NEAR(ray.norm(), 1.0, 1e-14);
      Eigen::Vector2d back;
      ASSERT_TRUE(camera_.project(ray * 3.7, back)) << u << " " << v;
      worst = std::max(worst, (back - Eigen::Vector2d(u, v)).norm());
    }
  }
  RecordProperty("worst_round_trip_px", std::to_string(worst * 1e9) + "e-9");
  EXPECT_LE(worst, 1e-6);
  if (GetParam().whole_image) {
    EXPECT_EQ(valid, all);
  } else {
    EXPECT_LT(valid, all);
    EXPECT_GT(valid, all / 4);
  }
}

// Over the whole valid domain, inside the image or not, rays come back: no folding.
TEST_P(EveryModel, RaysComeBackOverTheValidDomain) {
  for (double angle = 0.0; angle < camera_.maxAngle() - 1e-3; angle += 0.01) {
    for (int k = 0; k < 16; ++k) {
      const double phi = 2.0 * std::numbers::pi * k / 16.0;
      const Eigen::Vector3d ray(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi),
                                std::cos(angle));
      Eigen::Vector2d pixel;
      ASSERT_TRUE(camera_.project(ray, pixel)) << angle;
      Eigen::Vector3d back;
      ASSERT_TRUE(camera_.unproject(pixel, back)) << angle << " " << phi;
      EXPECT_LT((back - ray).norm(), 1e-8) << angle << " " << phi;
    }
  }
}

TEST_P(EveryModel, JacobianMatchesDifferences) {
  Random rng(3);
  for (int i = 0; i < 500; ++i) {
    const double angle = camera_.maxAngle() * (i < 20 ? 1e-4 * i : rng.uniform(0.0, 0.97));
    const double phi = rng.uniform(0.0, 2.0 * std::numbers::pi);
    const double depth = rng.uniform(0.5, 20.0);
    const Eigen::Vector3d p =
        depth * Eigen::Vector3d(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi),
                                std::cos(angle));
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> analytic;
    ASSERT_TRUE(camera_.project(p, pixel, &analytic));
    Eigen::Vector2d without;
    ASSERT_TRUE(camera_.project(p, without));
    EXPECT_EQ(pixel, without);
    Eigen::Matrix<double, 2, 3> numeric;
    const double step = 1e-5 * depth;
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector2d plus;
      Eigen::Vector2d minus;
      ASSERT_TRUE(camera_.project(p + step * Eigen::Vector3d::Unit(k), plus));
      ASSERT_TRUE(camera_.project(p - step * Eigen::Vector3d::Unit(k), minus));
      numeric.col(k) = (plus - minus) / (2.0 * step);
    }
    EXPECT_LT((analytic - numeric).norm(), 1e-6 * (1.0 + analytic.norm()))
        << "angle " << angle << "\n"
        << analytic << "\n\n"
        << numeric;
  }
}

TEST_P(EveryModel, TheAxisHasADifferentiableProjection) {
  Eigen::Vector2d center;
  Eigen::Matrix<double, 2, 3> jacobian;
  ASSERT_TRUE(camera_.project({0.0, 0.0, 2.0}, center, &jacobian));
  EXPECT_TRUE(jacobian.allFinite());
  EXPECT_NEAR(0.5 * (jacobian.row(0).norm() + jacobian.row(1).norm()) * 2.0, camera_.focalLength(),
              1e-3 * camera_.focalLength());
  Eigen::Vector3d ray;
  ASSERT_TRUE(camera_.unproject(center, ray));
  EXPECT_LT((ray - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  Eigen::Vector2d near;
  ASSERT_TRUE(camera_.project({1e-7, -2e-7, 2.0}, near));
  EXPECT_LT((near - center - jacobian.leftCols<2>() * Eigen::Vector2d(1e-7, -2e-7)).norm(), 1e-9);
}

TEST_P(EveryModel, RefusesWhatItCannotProject) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector2d pixel;
  EXPECT_FALSE(camera_.project({0.0, 0.0, 0.0}, pixel));
  EXPECT_FALSE(camera_.project({0.0, 0.0, -1.0}, pixel));
  EXPECT_FALSE(camera_.project({nan, 0.0, 1.0}, pixel));
  EXPECT_FALSE(camera_.project({0.0, nan, 1.0}, pixel));
  EXPECT_FALSE(camera_.project({0.0, 0.0, nan}, pixel));
  Eigen::Vector3d ray;
  EXPECT_FALSE(camera_.unproject({nan, 1.0}, ray));
  EXPECT_FALSE(camera_.unproject({1.0, nan}, ray));
  const double beyond = camera_.maxAngle() + 1e-4;
  EXPECT_TRUE(beyond > 30.0 * kDegree);
  if (beyond < std::numbers::pi) {
    EXPECT_FALSE(camera_.project({std::sin(beyond), 0.0, std::cos(beyond)}, pixel));
  }
}

TEST_P(EveryModel, ScalingKeepsTheRaysOfTheImage) {
  // The image's own corners and centre keep their rays; pixel centres move by half a pixel.
  for (const double factor : {0.5, 0.25, 2.0}) {
    const Camera small = camera_.scaled(factor);
    EXPECT_EQ(small.width(), std::lround(camera_.width() * factor));
    EXPECT_EQ(small.height(), std::lround(camera_.height() * factor));
    for (const Eigen::Vector2d& share :
         {Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(0.3, 0.4), Eigen::Vector2d(0.62, 0.55)}) {
      const Eigen::Vector2d pixel(share.x() * camera_.width() - 0.5,
                                  share.y() * camera_.height() - 0.5);
      const Eigen::Vector2d scaled(share.x() * small.width() - 0.5,
                                   share.y() * small.height() - 0.5);
      Eigen::Vector3d ray;
      Eigen::Vector3d scaled_ray;
      ASSERT_TRUE(camera_.unproject(pixel, ray));
      ASSERT_TRUE(small.unproject(scaled, scaled_ray));
      EXPECT_LT((ray - scaled_ray).norm(), 1e-10);
    }
    EXPECT_NEAR(small.focalLength(), factor * camera_.focalLength(), 1e-9);
    EXPECT_NEAR(small.maxAngle(), camera_.maxAngle(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cameras, EveryModel,
    testing::Values(Named{"Euroc", &euroc, true}, Named{"PlainPinhole", &plainPinhole, true},
                    Named{"Rational", &rational, true},
                    Named{"FoldingPinhole", &foldingPinhole, false}, Named{"Roecs", &roecs, true},
                    Named{"WideFisheye", &wideFisheye, true}, Named{"Omni", &omni, true},
                    Named{"Stereographic", &stereographic, true},
                    Named{"PerspectiveMei", &perspectiveMei, true},
                    Named{"MildOmni", &mildOmni, true}, Named{"Ocam", &ocam, true},
                    Named{"OcamWithBackward", &ocamWithBackward, true}),
    [](const auto& test) { return std::string(test.param.name); });

// Pixels that OpenCV 4.6 gives: projectPoints and fisheye::projectPoints with the same numbers.
TEST(Camera, AgreesWithOpenCv) {
  const Eigen::Vector3d points[] = {
      {0.3, -0.2, 1.0}, {-0.7, 0.4, 1.1}, {1.2, 0.9, 1.0}, {-2.0, 0.3, 0.7}};
  const struct {
    Camera camera;
    Eigen::Vector2d pixels[4];
  } cases[] = {{euroc(),
                {{499.90556853933458, 160.1887446901026},
                 {113.52035842037048, 392.96416836918752},
                 {772.94399379741503, 551.9563638264724},
                 {-4595.7549492711341, 991.3653350838598}}},
               {rational(),
                {{783.9411637591619, 263.20372416055869},
                 {362.73071665650815, 517.65003912426209},
                 {1023.9193610073373, 648.09577075550305},
                 {99.091540775004091, 440.85341174089223}}},
               {roecs(),
                {{733.35522303931577, 464.90140275195643},
                 {387.43720658913264, 673.53809884903671},
                 {922.5479093062047, 776.78000478110346},
                 {151.71464272250091, 614.05522429758798}}}};
  for (const auto& c : cases) {
    for (int i = 0; i < 4; ++i) {
      Eigen::Vector2d pixel;
      ASSERT_TRUE(c.camera.project(points[i], pixel));
      EXPECT_LT((pixel - c.pixels[i]).norm(), 1e-9 * c.pixels[i].norm()) << c.camera.modelName();
    }
  }
}

TEST(Camera, MeiWithUnitMirrorIsStereographic) {
  const Camera camera = stereographic();
  for (const double angle : {0.2, 1.0, 1.6, 2.5}) {
    Eigen::Vector2d pixel;
    ASSERT_TRUE(camera.project({0.0, 3.0 * std::sin(angle), 3.0 * std::cos(angle)}, pixel));
    EXPECT_NEAR(pixel.y(), 540.0 + 935.307436087 * std::tan(0.5 * angle), 1e-9);
    EXPECT_NEAR(pixel.x(), 960.0, 1e-9);
  }
}

TEST(Camera, MeiWithoutMirrorIsThePinhole) {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
  ASSERT_TRUE(plainPinhole().project({0.4, -0.2, 1.3}, a));
  ASSERT_TRUE(perspectiveMei().project({0.4, -0.2, 1.3}, b));
  EXPECT_LT((a - b).norm(), 1e-10);
}

TEST(Camera, ToolboxValuesSwapRowsAndColumns) {
  // A point to the right of the axis: in the toolbox's frame that is its second axis, the column.
  const std::vector<double> invpol = {0.5 * std::numbers::pi * 300.0, 300.0};
  const Ocam model(Ocam::fromToolbox({}, invpol, 240.0, 320.0, 1.01, 0.002, 0.003));
  Eigen::Vector2d pixel;
  ASSERT_TRUE(model.project({1.0, 0.0, 1.0}, pixel));
  const double rho = 300.0 * 45.0 * kDegree;
  EXPECT_NEAR(pixel.x(), 320.0 + rho, 1e-9);          // column = e x + y + yc
  EXPECT_NEAR(pixel.y(), 240.0 + 0.002 * rho, 1e-9);  // row = c x + d y + xc
  ASSERT_TRUE(model.project({0.0, 1.0, 1.0}, pixel));
  EXPECT_NEAR(pixel.x(), 320.0 + 0.003 * rho, 1e-9);
  EXPECT_NEAR(pixel.y(), 240.0 + 1.01 * rho, 1e-9);
}

TEST(Camera, OcamFollowsItsPolynomialAwayFromTheAxis) {
  const Camera camera = ocam();
  const Ocam::Parameters p = ocamParameters();
  for (const double angle : {0.11, 0.5, 1.2, 1.7}) {
    const double t = angle - 0.5 * std::numbers::pi;
    double rho = 0.0;
    for (std::size_t i = p.world2cam.size(); i-- > 0;) rho = rho * t + p.world2cam[i];
    Eigen::Vector2d pixel;
    ASSERT_TRUE(
        camera.project({0.6 * std::sin(angle), 0.8 * std::sin(angle), std::cos(angle)}, pixel));
    const Eigen::Vector2d expected =
        p.affine * Eigen::Vector2d(0.6 * rho, 0.8 * rho) + Eigen::Vector2d(p.cx, p.cy);
    EXPECT_LT((pixel - expected).norm(), 1e-9);
  }
}

TEST(Camera, KnowsItsImage) {
  const Camera camera = plainPinhole();
  EXPECT_TRUE(camera.inImage({-0.5, -0.5}));
  EXPECT_FALSE(camera.inImage({-0.51, 10.0}));
  EXPECT_TRUE(camera.inImage({639.4, 399.4}));
  EXPECT_FALSE(camera.inImage({639.5, 10.0}));
  EXPECT_FALSE(camera.inImage({10.0, 399.5}));
  EXPECT_FALSE(camera.inImage({4.4, 10.0}, 5.0));
  EXPECT_TRUE(camera.inImage({4.6, 10.0}, 5.0));
  EXPECT_FALSE(camera.inImage({std::numeric_limits<double>::quiet_NaN(), 10.0}));
}

TEST(Camera, StatesItsDomain) {
  EXPECT_NEAR(plainPinhole().maxAngle(), 89.5 * kDegree, 1e-9);
  // 1 + 3 k1 r^2 = 0 where only k1 acts.
  PinholeRadtan::Parameters p{300.0, 300.0, 0.0, 0.0, {}};
  p.distortion = radtan(-0.3, 0.0, 0.0, 0.0);
  EXPECT_NEAR(PinholeRadtan(p).maxAngle(), std::atan(std::sqrt(1.0 / 0.9)), 2e-3);
  // 1 + 3 k1 theta^2 = 0.
  EXPECT_NEAR(PinholeEquidistant({1.0, 1.0, 0.0, 0.0, -0.1, 0.0, 0.0, 0.0}).maxAngle(),
              std::sqrt(1.0 / 0.3), 1e-9);
  EXPECT_GT(wideFisheye().maxAngle(), 100.0 * kDegree);
  // cos(angle) = -1 / xi.
  EXPECT_NEAR(Mei({2.0, 1.0, 1.0, 0.0, 0.0, {}}).maxAngle(), 120.0 * kDegree, 1e-6);
  EXPECT_NEAR(stereographic().maxAngle(), 179.0 * kDegree, 1e-9);
}

TEST(Camera, RefusesMeaninglessParameters) {
  EXPECT_THROW(PinholeRadtan({0.0, 1.0, 0.0, 0.0, {}}), CheckError);
  EXPECT_THROW(PinholeEquidistant({1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}), CheckError);
  EXPECT_THROW(Mei({-0.1, 1.0, 1.0, 0.0, 0.0, {}}), CheckError);
  Ocam::Parameters p = ocamParameters();
  p.world2cam[0] += 10.0;  // far from 0 on the axis
  EXPECT_THROW(Ocam{p}, CheckError);
  EXPECT_THROW(Camera(Mei(), 0, 10), CheckError);
}

}  // namespace
}  // namespace parkade
