// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// What the simulator's rigs see of the ground around the car, and how far neighbours overlap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>

#include "parkade/camera/rig.hpp"

namespace parkade {
namespace {

Rig load(const std::string& name) {
  Result<Rig> rig = readRig(std::string(PARKADE_SOURCE_DIR) + "/config/rigs/" + name + ".yaml");
  EXPECT_TRUE(rig.ok()) << (rig.ok() ? "" : rig.error().message);
  return rig.ok() ? *rig : Rig{};
}

// Whether the body, taken as a box, stands between a camera and a point.
bool hiddenByBody(const VehicleShape& body, const Eigen::Vector3d& eye, const Eigen::Vector3d& p) {
  const Eigen::Vector3d low(-body.rear_overhang, -0.5 * body.width, 0.0);
  const Eigen::Vector3d high(body.wheelbase + body.front_overhang, 0.5 * body.width, body.height);
  double enter = 0.0;
  double leave = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double direction = p[k] - eye[k];
    if (std::abs(direction) < 1e-12) {
      if (eye[k] <= low[k] || eye[k] >= high[k]) return false;
      continue;
    }
    const double a = (low[k] - eye[k]) / direction;
    const double b = (high[k] - eye[k]) / direction;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave;
}

bool sees(const Rig& rig, std::size_t camera, const Eigen::Vector3d& p_vehicle) {
  constexpr double kMarginPx = 2.0;
  const RigCamera& c = rig.cameras[camera];
  Eigen::Vector2d pixel;
  return c.camera.project(c.T_vehicle_cam.inverse() * p_vehicle, pixel) &&
         c.camera.inImage(pixel, kMarginPx) &&
         !hiddenByBody(*rig.vehicle, c.T_vehicle_cam.translation(), p_vehicle);
}

// Points on the ground on the rectangle that runs a distance outside the body.
std::vector<Eigen::Vector3d> ring(const VehicleShape& body, double distance) {
  constexpr int kPoints = 500;
  const double x0 = -body.rear_overhang - distance;
  const double x1 = body.wheelbase + body.front_overhang + distance;
  const double y = 0.5 * body.width + distance;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < kPoints; ++i) {
    const double t = static_cast<double>(i) / (kPoints - 1);
    const double along = x0 + t * (x1 - x0);
    const double across = -y + t * 2.0 * y;
    points.insert(points.end(),
                  {{along, y, 0.0}, {along, -y, 0.0}, {x0, across, 0.0}, {x1, across, 0.0}});
  }
  return points;
}

// Share of a ring that at least one camera sees.
double coverage(const Rig& rig, double distance) {
  const std::vector<Eigen::Vector3d> points = ring(*rig.vehicle, distance);
  const auto seen = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      if (sees(rig, i, p)) return true;
    }
    return false;
  });
  return static_cast<double>(seen) / static_cast<double>(points.size());
}

// Degrees of azimuth, on the horizon, that both cameras see.
double overlapDeg(const Rig& rig, std::size_t a, std::size_t b) {
  constexpr double kStepDeg = 0.1;
  int count = 0;
  for (double azimuth = 0.0; azimuth < 360.0; azimuth += kStepDeg) {
    const double angle = azimuth * std::numbers::pi / 180.0;
    // So far away that the cameras' places make no difference.
    const Eigen::Vector3d far = 1e7 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    if (sees(rig, a, far) && sees(rig, b, far)) ++count;
  }
  return kStepDeg * count;
}

TEST(Avp6, SeesTheGroundAllAroundFromOneMetre) {
  const Rig rig = load("avp6");
  ASSERT_EQ(rig.cameras.size(), 6U);
  double nearest = 2.0;
  while (nearest > 0.0 && coverage(rig, nearest - 0.05) == 1.0) nearest -= 0.05;
  RecordProperty("covered_from_m", std::to_string(nearest));
  std::printf("avp6 covers the ground from %.2f m outside the body\n", nearest);
  EXPECT_LE(nearest, 1.0);
  for (double distance = 1.0; distance <= 10.0; distance += 0.25) {
    EXPECT_EQ(coverage(rig, distance), 1.0) << distance << " m";
  }
}

TEST(Avp6, NeighboursOverlap) {
  const Rig rig = load("avp6");
  ASSERT_EQ(rig.cameras.size(), 6U);
  double least = 360.0;
  for (std::size_t i = 0; i < 6; ++i) least = std::min(least, overlapDeg(rig, i, (i + 1) % 6));
  RecordProperty("least_overlap_deg", std::to_string(least));
  std::printf("avp6 neighbours overlap by at least %.1f deg on the horizon\n", least);
  EXPECT_GE(least, 20.0);
}

// The ground that two neighbours both see, so that tracks and stitching can pass from one to the
// other: at 2 m, every pair of neighbours shares a piece of the ring.
TEST(Avp6, NeighboursShareGround) {
  const Rig rig = load("avp6");
  ASSERT_EQ(rig.cameras.size(), 6U);
  const std::vector<Eigen::Vector3d> points = ring(*rig.vehicle, 2.0);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t next = (i + 1) % 6;
    const auto shared = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
      return sees(rig, i, p) && sees(rig, next, p);
    });
    EXPECT_GT(shared, 50) << i << " and " << next;
  }
}

TEST(Avm4, SeesTheGroundAllAroundFromOneMetre) {
  const Rig rig = load("avm4");
  ASSERT_EQ(rig.cameras.size(), 4U);
  for (double distance = 1.0; distance <= 6.0; distance += 0.5) {
    EXPECT_EQ(coverage(rig, distance), 1.0) << distance << " m";
  }
  for (std::size_t i = 0; i < 4; ++i) EXPECT_GE(overlapDeg(rig, i, (i + 1) % 4), 20.0);
}

TEST(Nuscenes6, LooksAllAroundButSeesTheGroundOnlyFromAfar) {
  const Rig rig = load("nuscenes6");
  ASSERT_EQ(rig.cameras.size(), 6U);
  EXPECT_LT(coverage(rig, 1.0), 0.2);
  // All around on the horizon, with the small overlaps of the data set.
  for (std::size_t i = 0; i < 6; ++i) EXPECT_GT(overlapDeg(rig, i, (i + 1) % 6), 2.0);
  // The front camera looks ahead: a point far ahead falls on the middle of its picture.
  Eigen::Vector2d pixel;
  const RigCamera& front = rig.cameras[0];
  ASSERT_TRUE(front.camera.project(
      front.T_vehicle_cam.inverse() * Eigen::Vector3d(1000.0, 0.016, 1.511), pixel));
  EXPECT_LT((pixel - Eigen::Vector2d(399.5, 224.5)).norm(), 1e-6);
}

TEST(RigFiles, AllAreRead) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(PARKADE_SOURCE_DIR) + "/config/rigs")) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    const Rig rig = load(entry.path().stem().string());
    EXPECT_EQ(rig.name, entry.path().stem().string());
    // Every picture has a ray in its middle, and cameras of a car look out from above the ground.
    for (const RigCamera& camera : rig.cameras) {
      const Eigen::Vector2d middle(0.5 * (camera.camera.width() - 1),
                                   0.5 * (camera.camera.height() - 1));
      Eigen::Vector3d ray;
      ASSERT_TRUE(camera.camera.unproject(middle, ray)) << rig.name << " " << camera.name;
      if (rig.vehicle) {
        EXPECT_GT(camera.T_vehicle_cam.translation().z(), 0.5) << rig.name << " " << camera.name;
        EXPECT_LT((camera.T_vehicle_cam.rotation() * ray).z(), 0.1) << rig.name;
      }
    }
  }
  EXPECT_GE(count, 7);
}

TEST(SimulatorRigs, AllCamerasStandOutsideTheBody) {
  for (const char* name : {"avp6", "nuscenes6", "avm4"}) {
    const Rig rig = load(name);
    ASSERT_TRUE(rig.vehicle.has_value()) << name;
    for (const RigCamera& camera : rig.cameras) {
      const Eigen::Vector3d p = camera.T_vehicle_cam.translation();
      const bool inside = p.x() > -rig.vehicle->rear_overhang &&
                          p.x() < rig.vehicle->wheelbase + rig.vehicle->front_overhang &&
                          std::abs(p.y()) < 0.5 * rig.vehicle->width && p.z() < rig.vehicle->height;
      EXPECT_FALSE(inside) << name << " " << camera.name;
    }
  }
}

}  // namespace
}  // namespace parkade
