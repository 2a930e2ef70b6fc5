// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/object_extraction.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>

#include <cmath>

namespace parkade {
namespace {

// Upright boxes as a camera over the picture's middle smears them: what lies behind a box, seen
// from the camera, up to where the ray over its top meets the floor.
class Scene {
 public:
  explicit Scene(double camera_height = 1.0) {
    labels.geometry.center = {1.4, 0.0};
    const BevGeometry& g = labels.geometry;
    labels.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(1));
    labels.confidence = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(230));
    views = BevViews::fromMiddle(g, camera_height);
  }
  // From bottom to top (m) over the floor.
  void stand(SemanticClass c, const GroundBox& box, double bottom, double top) {
    const BevGeometry& g = labels.geometry;
    const BevViews::View& view = views.views.front();
    for (int v = 0; v < g.height_px; ++v) {
      for (int u = 0; u < g.width_px; ++u) {
        const Eigen::Vector2d ray = g.toGround(Eigen::Vector2d(u, v)) - view.foot;
        // The sight line at height z is over foot + ray * (1 - z / h).
        bool hit = false;
        double share = 1.0 - bottom / view.height;
        const double least = std::max(0.02, 1.0 - top / view.height);
        for (; share > least && !hit; share -= 0.02 * share + 0.002) {
          hit = box.contains(view.foot + share * ray, 0.0);
        }
        if (hit) labels.labels.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(c);
      }
    }
  }
  void cover(const Eigen::Vector2d& low, const Eigen::Vector2d& high, SemanticClass c) {
    const BevGeometry& g = labels.geometry;
    for (int v = 0; v < g.height_px; ++v) {
      for (int u = 0; u < g.width_px; ++u) {
        const Eigen::Vector2d p = g.toGround(Eigen::Vector2d(u, v));
        if ((p - low).minCoeff() < 0.0 || (high - p).minCoeff() < 0.0) continue;
        labels.labels.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(c);
      }
    }
  }
  [[nodiscard]] FoundObjects extract() const {
    return ObjectExtractor(labels.geometry, views).extract(labels, slots, 0.003);
  }
  BevLabels labels;
  BevViews views;
  std::vector<SlotObservation> slots;
};

GroundBox box(double x, double y, double heading, double length, double width) {
  return {{x, y}, heading, {length, width}};
}

TEST(ObjectExtraction, PillarsStandWhereTheyMeetTheFloor) {
  for (const double heading : {0.0, 0.3, 0.7}) {
    Scene scene;
    const GroundBox pillar = box(5.0, 3.0, heading, 0.7, 0.7);
    scene.stand(SemanticClass::kPillar, pillar, 0.0, 2.5);
    const FoundObjects found = scene.extract();
    ASSERT_EQ(found.objects.size(), 1U) << heading;
    const ObjectObservation& o = found.objects[0];
    EXPECT_EQ(o.semantic_class, SemanticClass::kPillar);
    EXPECT_LT((o.position.head<2>() - pillar.center).norm(), 0.08) << heading;
    EXPECT_EQ(o.outline.size(), 4U);
    EXPECT_EQ(found.agents.size(), 0U);
  }
}

TEST(ObjectExtraction, FaceOnPillarsAreLessSureInDepth) {
  Scene scene;
  scene.stand(SemanticClass::kPillar, box(1.4, 4.0, 0.0, 0.7, 0.7), 0.0, 2.5);
  const FoundObjects found = scene.extract();
  ASSERT_EQ(found.objects.size(), 1U);
  EXPECT_LT((found.objects[0].position.head<2>() - Eigen::Vector2d(1.4, 4.0)).norm(), 0.08);
  EXPECT_GT(found.objects[0].covariance(1, 1), 2.0 * found.objects[0].covariance(0, 0));
}

TEST(ObjectExtraction, WallsAreNoPillars) {
  Scene scene;
  scene.cover({-8.0, 4.0}, {9.0, 8.0}, SemanticClass::kPillar);
  EXPECT_TRUE(scene.extract().objects.empty());
}

TEST(ObjectExtraction, PeopleStandBetweenTheirFeet) {
  Scene scene;
  const Eigen::Vector2d feet(5.0, -2.5);
  for (const double side : {-0.12, 0.12}) {
    scene.stand(SemanticClass::kPedestrian, box(feet.x() + side, feet.y(), 0.0, 0.25, 0.1), 0.0,
                0.8);
  }
  scene.stand(SemanticClass::kPedestrian, box(feet.x(), feet.y(), 0.0, 0.3, 0.5), 0.75, 1.7);
  const FoundObjects found = scene.extract();
  ASSERT_EQ(found.agents.size(), 1U);
  EXPECT_EQ(found.agents[0].semantic_class, SemanticClass::kPedestrian);
  EXPECT_LT((found.agents[0].contact - feet).norm(), 0.2);
}

// Where the pictures of two cameras are blended, a person is smeared away from either.
TEST(ObjectExtraction, APersonSeenByTwoCamerasIsOne) {
  Scene scene;
  const Eigen::Vector2d feet(5.0, -2.5);
  scene.stand(SemanticClass::kPedestrian, box(feet.x(), feet.y(), 0.0, 0.3, 0.4), 0.0, 1.7);
  const BevViews::View other{{1.4, 1.5}, 1.0};
  scene.views.views.push_back(other);
  const Eigen::Vector2d pixel = scene.labels.geometry.toPixel(feet);
  scene.views.view_of(
      cv::Rect(static_cast<int>(pixel.x()) - 15, static_cast<int>(pixel.y()) - 15, 30, 30)) = 1;
  const Eigen::Vector2d ray = (feet - other.foot).normalized();
  for (double behind = 2.0; behind < 3.2; behind += 0.1) {
    const Eigen::Vector2d p = feet + behind * ray;
    scene.cover(p.array() - 0.15, p.array() + 0.15, SemanticClass::kPedestrian);
  }
  const FoundObjects found = scene.extract();
  ASSERT_EQ(found.agents.size(), 1U);
  EXPECT_LT((found.agents[0].contact - feet).norm(), 0.3);
}

TEST(ObjectExtraction, SpecksAreNoPeopleUnlessTheyAreSure) {
  for (const int sure : {130, 230}) {
    Scene scene;
    scene.cover({4.0, -3.0}, {4.3, -2.7}, SemanticClass::kPedestrian);
    scene.labels.confidence.setTo(sure);
    EXPECT_EQ(scene.extract().agents.size(), sure == 230 ? 1U : 0U);
  }
}

TEST(ObjectExtraction, CarsSideBySideAreTwo) {
  Scene scene(0.9);
  const GroundBox left = box(1.6, 6.0, M_PI_2, 4.0, 1.8);
  const GroundBox right = box(4.1, 6.0, M_PI_2, 4.0, 1.8);
  for (const GroundBox& car : {left, right}) scene.stand(SemanticClass::kVehicle, car, 0.2, 1.5);
  const FoundObjects found = scene.extract();
  ASSERT_EQ(found.agents.size(), 2U);
  EXPECT_TRUE(found.objects.empty());
  for (const AgentDetection& agent : found.agents) {
    const GroundBox& car = agent.contact.x() < 2.85 ? left : right;
    const Eigen::Vector2d nearest = car.nearestTo(scene.labels.geometry.center);
    EXPECT_LT((agent.contact - nearest).norm(), 0.35) << agent.contact.transpose();
    EXPECT_GT(agent.covariance.determinant(), 0.0);
  }
}

// From far along their row the gap between two cars is hidden.
TEST(ObjectExtraction, CarsInSlotsAreTwoWhereNoGapIsSeen) {
  Scene scene(0.9);
  const GroundBox near = box(-1.7, 4.6, M_PI_2, 4.0, 1.9);
  const GroundBox far = box(-3.9, 4.6, M_PI_2, 4.0, 1.9);
  for (const GroundBox& car : {near, far}) scene.stand(SemanticClass::kVehicle, car, 0.2, 1.5);
  EXPECT_EQ(scene.extract().agents.size(), 1U);
  for (const double x : {-2.8, -5.0}) {
    SlotObservation slot;
    slot.corners = {Eigen::Vector2d(x, 2.4), Eigen::Vector2d(x + 2.2, 2.4),
                    Eigen::Vector2d(x + 2.2, 7.0), Eigen::Vector2d(x, 7.0)};
    scene.slots.push_back(slot);
  }
  const FoundObjects found = scene.extract();
  ASSERT_EQ(found.agents.size(), 2U);
  for (const AgentDetection& agent : found.agents) {
    const GroundBox& car = agent.contact.x() > -2.8 ? near : far;
    EXPECT_LT((agent.contact - car.nearestTo(agent.contact)).norm(), 0.4);
  }
}

// Their own slots are not told, but one of their row is.
TEST(ObjectExtraction, CarsInARowOfSlotsAreTwo) {
  Scene scene(0.9);
  const GroundBox near = box(-1.7, 4.6, M_PI_2, 4.0, 1.9);
  const GroundBox far = box(-3.9, 4.6, M_PI_2, 4.0, 1.9);
  for (const GroundBox& car : {near, far}) scene.stand(SemanticClass::kVehicle, car, 0.2, 1.5);
  SlotObservation slot;
  slot.corners = {Eigen::Vector2d(-0.6, 2.4), Eigen::Vector2d(1.6, 2.4), Eigen::Vector2d(1.6, 7.0),
                  Eigen::Vector2d(-0.6, 7.0)};
  scene.slots.push_back(slot);
  const FoundObjects found = scene.extract();
  ASSERT_EQ(found.agents.size(), 2U);
  for (const AgentDetection& agent : found.agents) {
    EXPECT_NEAR(std::abs(std::remainder(agent.box.heading, M_PI_2)), 0.0, 1e-9);
  }
  // One that passes before the row, along it, is no two.
  Scene aisle(0.9);
  for (Eigen::Vector2d& corner : slot.corners) corner.y() += 3.0;
  aisle.slots.push_back(slot);
  aisle.stand(SemanticClass::kVehicle, box(0.4, 3.0, 0.0, 4.5, 1.8), 0.2, 1.5);
  EXPECT_EQ(aisle.extract().agents.size(), 1U);
}

TEST(ObjectExtraction, OneCarFromItsSideIsOne) {
  Scene scene(0.9);
  const GroundBox body = box(3.0, -3.5, 0.0, 4.5, 1.8);
  scene.stand(SemanticClass::kVehicle, body, 0.25, 1.5);
  for (const double x : {-1.4, 1.4}) {  // wheels
    scene.stand(SemanticClass::kVehicle, box(3.0 + x, -2.75, 0.0, 0.5, 0.2), 0.0, 0.6);
  }
  const FoundObjects found = scene.extract();
  ASSERT_EQ(found.agents.size(), 1U);
  EXPECT_LT((found.agents[0].contact - Eigen::Vector2d(1.6, -2.65)).norm(), 0.3);
  EXPECT_GT(found.agents[0].box.size.x(), 3.5);
}

}  // namespace
}  // namespace parkade
