// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Pictures agree with the camera models: corners of paint found in rendered pictures against their
// projections, and label images against points of known objects.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "parkade/sim/render/exactness_support.hpp"
#include "parkade/sim/render/test_scene.hpp"

namespace parkade::sim {
namespace {

using test::cornerError;
using test::paintOnly;
using test::quietOptions;

const std::vector<test::PaintedRect>& squares() {
  static const std::vector<test::PaintedRect> kSquares = [] {
    std::vector<test::PaintedRect> rects;
    for (int i = 0; i < 4; ++i) {
      for (int j = -2; j <= 1; ++j) {
        const Eigen::Vector2f low(-4.9F + 1.1F * i, 0.2F + 1.1F * j);
        rects.push_back({low, low + Eigen::Vector2f(0.75F, 0.7F), Eigen::Vector3f::Constant(0.7F),
                         SemanticClass::kSlotLine});
      }
    }
    return rects;
  }();
  return kSquares;
}

class EveryModel : public testing::TestWithParam<test::Model> {};

TEST_P(EveryModel, CornersOfPaintLieWhereTheyProject) {
  const Camera camera = GetParam().make();
  for (const bool fast : {false, true}) {
    const SE3 T_world_cam = test::lookAlongX(0.45);
    const auto draw = [&](const std::vector<test::PaintedRect>& rects) {
      Renderer renderer(test::makeHall(rects), quietOptions(fast));
      const int index = renderer.addCamera(camera);
      return renderer.render(index, T_world_cam, *renderer.moment(0.0, std::nullopt), 0);
    };
    const cv::Mat image = paintOnly(draw(squares()), draw({}));
    const SE3 T_cam_world = T_world_cam.inverse();
    const auto project = [&](const Eigen::Vector2d& p, Eigen::Vector2d& pixel) {
      return camera.project(T_cam_world * Eigen::Vector3d(p.x(), p.y(), 0.0), pixel);
    };
    int measured = 0;
    double worst = 0.0;
    for (const test::PaintedRect& r : squares()) {
      const Eigen::Vector2d low = r.min.cast<double>();
      const Eigen::Vector2d size = r.max.cast<double>() - low;
      for (int c = 0; c < 4; ++c) {
        const double sx = c % 2 == 0 ? 1.0 : -1.0;
        const double sy = c / 2 == 0 ? 1.0 : -1.0;
        const Eigen::Vector2d corner = low + size.cwiseProduct(Eigen::Vector2d(c % 2, c / 2));
        Eigen::Vector2d error;
        if (cornerError(image, project, corner, {sx * size.x(), 0.0}, {0.0, sy * size.y()},
                        error)) {
          ++measured;
          worst = std::max(worst, error.norm());
        }
      }
    }
    EXPECT_GE(measured, 10) << (fast ? "fast" : "anti-aliased");
    EXPECT_LT(worst, 0.1) << (fast ? "fast" : "anti-aliased") << ", " << measured << " corners";
    RecordProperty(fast ? "worst_px_fast" : "worst_px", std::to_string(worst));
  }
}

TEST_P(EveryModel, LabelsAgreeWithProjectedPoints) {
  const Camera camera = GetParam().make();
  Renderer renderer(test::makeHall(squares()), quietOptions(true));
  const int index = renderer.addCamera(camera);
  const SE3 T_world_cam = test::lookAlongX(0.3);
  const TruthImages truth =
      renderer.renderTruth(index, T_world_cam, *renderer.moment(0.0, std::nullopt));
  const auto check = [&](const Eigen::Vector3d& p, SemanticClass label, int instance) {
    Eigen::Vector2d pixel;
    const Eigen::Vector3d p_cam = T_world_cam.inverse() * p;
    if (!camera.project(p_cam, pixel) || !camera.inImage(pixel, 1.0)) {
      return 0;
    }
    const int x = static_cast<int>(std::lround(pixel.x()));
    const int y = static_cast<int>(std::lround(pixel.y()));
    EXPECT_EQ(truth.labels.at<std::uint8_t>(y, x), static_cast<std::uint8_t>(label)) << p;
    EXPECT_EQ(truth.instances.at<std::int32_t>(y, x), instance) << p;
    EXPECT_NEAR(truth.depths.at<float>(y, x), p_cam.norm(), 0.05 * p_cam.norm()) << p;
    return 1;
  };
  int seen = 0;
  for (const test::PaintedRect& r : squares()) {
    const Eigen::Vector2d middle = 0.5 * (r.min + r.max).cast<double>();
    seen += check({middle.x(), middle.y(), 0.0}, SemanticClass::kSlotLine, 0);
    seen += check({middle.x() + 0.55, middle.y(), 0.0}, SemanticClass::kFloor, 0);
  }
  seen += check({4.0, 1.8, 1.0}, SemanticClass::kPillar, 1);
  seen += check({1.5, -4.6, 0.8}, SemanticClass::kVehicle, 2);
  seen += check({3.0, -3.7, 0.8}, SemanticClass::kVehicle, 2);
  seen += check({10.0, 0.0, 1.5}, SemanticClass::kWall, 0);
  EXPECT_GE(seen, 20);
}

INSTANTIATE_TEST_SUITE_P(Cameras, EveryModel, testing::ValuesIn(test::models()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace parkade::sim
