// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Pictures and labels of the paper's garage agree with its own geometry, for every camera model.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "parkade/sim/render/exactness_support.hpp"
#include "parkade/sim/render/paint_truth.hpp"
#include "parkade/sim/world/floor_surface.hpp"
#include "parkade/sim/world/generate.hpp"
#include "parkade/sim/world/polygon.hpp"
#include "parkade/sim/world/scene_builder.hpp"

namespace parkade::sim {
namespace {

const Garage& paperGarage() {
  static const Garage kGarage = [] {
    Garage garage = generateGarage(GarageOptions{}).value();
    for (Slot& slot : garage.slots) slot.occupied = false;
    return garage;
  }();
  return kGarage;
}

enum Floor : std::size_t {
  kOwn,    ///< with fresh paint
  kPlain,  ///< stop lines and crossings on a floor without grain, whose speckles hide hundredths of
           ///< a pixel
  kBare,   ///< the same without paint
};

/// The garage's floor, which changes at a word: one bake of the light serves all of them.
class Floors final : public FloorSurface {
 public:
  Floors() {
    const Garage& garage = paperGarage();
    floors_[kOwn] = buildFloor(garage, 0.0, 0.0);
    FloorLook look;
    look.grain = 0.0;
    look.dirt = 0.0;
    FloorPaint paint;
    for (const Marking& marking : garage.markings) {
      if (marking.semantic_class == SemanticClass::kStopLine ||
          marking.semantic_class == SemanticClass::kCrossing) {
        paint.polygons.insert(paint.polygons.end(), marking.polygons.begin(),
                              marking.polygons.end());
      }
    }
    floors_[kPlain] = makeFloorSurface(garage.min, garage.max, look, {paint});
    floors_[kBare] = makeFloorSurface(garage.min, garage.max, look, {});
  }
  [[nodiscard]] FloorSample sample(float x, float y, float footprint) const override {
    return floors_[shown]->sample(x, y, footprint);
  }
  [[nodiscard]] FloorSample mean(const float* x, const float* y, int count,
                                 float footprint) const override {
    return floors_[shown]->mean(x, y, count, footprint);
  }
  Floor shown = kOwn;

 private:
  std::array<std::shared_ptr<const FloorSurface>, 3> floors_;
};

/// A renderer of the empty garage, with light as coarse as can be.
const Renderer& rendererOf(Floor floor) {
  static const std::shared_ptr<Floors> kFloors = std::make_shared<Floors>();
  static const std::unique_ptr<Renderer> kRenderer = [] {
    SceneOptions options;
    options.wear = 0.0;
    options.dirt = 0.0;
    options.furniture = false;
    Scene scene = buildScene(paperGarage(), options);
    scene.floor = kFloors;
    RenderOptions render = test::quietOptions(false);
    render.sensor.fixed_gain = 1.5;  // no lamp's pool saturates
    render.bake.floor_cell = 1.0;
    render.bake.indirect_cell = 4.0;
    auto renderer =
        std::make_unique<Renderer>(std::make_shared<const Scene>(std::move(scene)), render);
    for (const test::Model& model : test::models()) renderer->addCamera(model.make());
    return renderer;
  }();
  kFloors->shown = floor;
  return *kRenderer;
}

Eigen::Vector3d onFloor(const Eigen::Vector2d& p) {
  return {p.x(), p.y(), paperGarage().floorHeight(p)};
}

/// A camera 1 m over the floor that looks down at a place from a distance, out of a heading.
SE3 lookAt(const Eigen::Vector2d& place, double heading, double distance) {
  const Eigen::Vector2d from =
      place - distance * Eigen::Vector2d(std::cos(heading), std::sin(heading));
  const Eigen::Vector3d eye = onFloor(from) + Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d R;  // x right, y down, z forward
  R.col(2) = (onFloor(place) - eye).normalized();
  R.col(0) = R.col(2).cross(Eigen::Vector3d::UnitZ()).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return {SO3(R), eye};
}

/// Rectangles of paint with room around them: stop lines and bars of crossings.
std::vector<Polygon> rectangles(std::size_t wanted) {
  std::vector<Polygon> found;
  for (const Marking& marking : paperGarage().markings) {
    if (marking.semantic_class == SemanticClass::kStopLine ||
        marking.semantic_class == SemanticClass::kCrossing) {
      found.push_back(marking.polygons[marking.polygons.size() / 2]);
    }
  }
  // Spread over the garage.
  std::vector<Polygon> chosen;
  for (std::size_t i = 0; i < wanted && !found.empty(); ++i) {
    chosen.push_back(found[i * found.size() / wanted]);
  }
  return chosen;
}

class PaperGarage : public testing::TestWithParam<int> {};

TEST_P(PaperGarage, CornersOfMarkingsLieWhereTheyProject) {
  const int index = GetParam();
  const Camera camera = test::models()[static_cast<std::size_t>(index)].make();
  int measured = 0;
  double worst = 0.0;
  for (const Polygon& polygon : rectangles(3)) {
    ASSERT_EQ(polygon.size(), 4U);
    for (const std::size_t c : {0U, 2U}) {
      const Eigen::Vector2d& corner = polygon[c];
      const Eigen::Vector2d to_next = polygon[(c + 1) % 4] - corner;
      const Eigen::Vector2d to_last = polygon[(c + 3) % 4] - corner;
      // 0.9 m of the edges will do; the camera looks along their bisector.
      const Eigen::Vector2d a = std::min(1.0, 0.9 / to_next.norm()) * to_next;
      const Eigen::Vector2d b = std::min(1.0, 0.9 / to_last.norm()) * to_last;
      const Eigen::Vector2d bisector = to_next.normalized() + to_last.normalized();
      const SE3 T_world_cam = lookAt(corner, std::atan2(bisector.y(), bisector.x()), 0.7);
      const SE3 T_cam_world = T_world_cam.inverse();
      const auto draw = [&](Floor floor) {
        const Renderer& renderer = rendererOf(floor);
        return renderer.render(index, T_world_cam, *renderer.moment(0.0, std::nullopt), 0);
      };
      const auto project = [&](const Eigen::Vector2d& p, Eigen::Vector2d& pixel) {
        return camera.project(T_cam_world * onFloor(p), pixel);
      };
      Eigen::Vector2d error;
      if (test::cornerError(test::paintOnly(draw(kPlain), draw(kBare)), project, corner, a, b,
                            error)) {
        ++measured;
        worst = std::max(worst, error.norm());
      }
    }
  }
  EXPECT_GE(measured, 5);
  EXPECT_LT(worst, 0.1) << measured << " corners";
  RecordProperty("worst_px", std::to_string(worst));
}

TEST_P(PaperGarage, LabelsAgreeWithGeometry) {
  const int index = GetParam();
  const Camera camera = test::models()[static_cast<std::size_t>(index)].make();
  const Renderer& renderer = rendererOf(kOwn);
  const SE3 T_world_cam = lookAt(rectangles(3)[1][0], 0.6, 3.0);
  const TruthImages truth =
      renderer.renderTruth(index, T_world_cam, *renderer.moment(0.0, std::nullopt));
  const test::PaintTruth paint(paperGarage());
  int on_floor = 0;
  int on_paint = 0;
  int on_pillars = 0;
  for (int y = 0; y < truth.labels.rows; y += 5) {
    for (int x = 0; x < truth.labels.cols; x += 5) {
      Eigen::Vector3d ray;
      const double depth = truth.depths.at<float>(y, x);
      if (depth <= 0.0 || depth > 15.0 || !camera.unproject({x, y}, ray)) continue;
      const Eigen::Vector3d p = T_world_cam * Eigen::Vector3d(depth * ray.normalized());
      const auto label = static_cast<SemanticClass>(truth.labels.at<std::uint8_t>(y, x));
      const double above = p.z() - paperGarage().floorHeight(p.head<2>());
      if (label == SemanticClass::kPillar || label == SemanticClass::kZoneMarker) {
        EXPECT_TRUE(test::inPillar(paperGarage(), p.head<2>()))
            << x << ", " << y << ": no pillar at " << p.transpose();
        ++on_pillars;
      } else if (std::abs(above) < 1e-3) {
        const SemanticClass expected = paint.at(p.head<2>());
        if (expected == SemanticClass::kUnknown || label == SemanticClass::kWall) continue;
        EXPECT_EQ(static_cast<int>(label), static_cast<int>(expected))
            << x << ", " << y << " at " << p.transpose();
        ++(expected == SemanticClass::kFloor ? on_floor : on_paint);
      }
    }
  }
  EXPECT_GT(on_floor, 500);
  EXPECT_GT(on_paint, 50);
  EXPECT_GT(on_pillars, 5);
}

INSTANTIATE_TEST_SUITE_P(Cameras, PaperGarage, testing::Range(0, 4), [](const auto& test) {
  return std::string(test::models()[static_cast<std::size_t>(test.param)].name);
});

}  // namespace
}  // namespace parkade::sim
