// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Label images of simulated drives: the ones on record, for any number of threads, and what they
// say against the garage itself. The record is renewed, where a change is meant, by
//   PARKADE_WRITE_LABELS=1 parkade_sim_test --gtest_filter='*LabelImages.AreThoseOnRecord*'
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "parkade/sim/drive/drive_shot.hpp"
#include "parkade/sim/render/paint_truth.hpp"
#include "parkade/sim/world/parked_cars.hpp"
#include "parkade/sim/world/polygon.hpp"

namespace parkade::sim {
namespace {

using test::Drive;
using test::kGroundMetresPerPx;
using test::kGroundPx;
using test::kSmall;
using test::Shot;

/// All cameras in two rows, the ground from above to their right.
cv::Mat allLabels(const Shot& shot) {
  cv::Mat sheet(kGroundPx, 3 * 160 + kGroundPx, CV_8UC1, cv::Scalar(0));
  for (int i = 0; i < 6; ++i) {
    shot.truth(i).labels.copyTo(sheet(cv::Rect(i % 3 * 160, i / 3 * 100, 160, 100)));
  }
  shot.ground().labels.copyTo(sheet(cv::Rect(3 * 160, 0, kGroundPx, kGroundPx)));
  return sheet;
}

std::string nameOf(int label) {
  return label >= 0 && label < kNumSemanticClasses
             ? std::string(kSemanticClassNames[static_cast<std::size_t>(label)])
             : std::to_string(label);
}

class LabelImages : public testing::TestWithParam<Drive> {};

TEST_P(LabelImages, AreThoseOnRecord) {
  const std::string path =
      std::string(PARKADE_SOURCE_DIR) + "/tests/data/labels/" + GetParam().name + ".png";
  const cv::Mat now = allLabels(Shot(GetParam()));
  if (std::getenv("PARKADE_WRITE_LABELS") != nullptr) {
    ASSERT_TRUE(cv::imwrite(path, now)) << path;
  }
  const cv::Mat record = cv::imread(path, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(record.size(), now.size()) << path;
  ASSERT_EQ(record.type(), now.type()) << path;
  std::map<std::string, int> changes;
  int changed = 0;
  for (int y = 0; y < now.rows; ++y) {
    for (int x = 0; x < now.cols; ++x) {
      const int before = record.at<std::uint8_t>(y, x);
      const int after = now.at<std::uint8_t>(y, x);
      if (before == after) continue;
      ++changed;
      ++changes[nameOf(before) + " became " + nameOf(after)];
    }
  }
  // Another compiler may round a few rays to the other side of an edge.
  constexpr int kRounded = 20;
  std::string list;
  for (const auto& [change, count] : changes)
    list += "\n  " + change + ": " + std::to_string(count);
  EXPECT_LE(changed, kRounded) << path << ": pixels that differ" << list;
}

bool sameBytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && a.isContinuous() && b.isContinuous() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

TEST_P(LabelImages, DoNotDependOnThreads) {
  // Everything twice, so that the garage, its light and the drive are made twice as well.
  constexpr int kBounces = 1;
  const Shot one(GetParam(), 1, kBounces);
  const Shot two(GetParam(), 2, kBounces);
  for (int i = 0; i < 6; ++i) {
    SCOPED_TRACE(i);
    const TruthImages a = one.truth(i);
    const TruthImages b = two.truth(i);
    EXPECT_TRUE(sameBytes(a.labels, b.labels));
    EXPECT_TRUE(sameBytes(a.instances, b.instances));
    EXPECT_TRUE(sameBytes(a.depths, b.depths));
    const Radiance light = one.radiance(i);
    const Radiance other = two.radiance(i);
    ASSERT_EQ(light.pixels.size(), other.pixels.size());
    EXPECT_EQ(std::memcmp(light.pixels.data(), other.pixels.data(),
                          light.pixels.size() * sizeof(light.pixels[0])),
              0);
  }
  const OrthoImages a = one.ground();
  const OrthoImages b = two.ground();
  EXPECT_TRUE(sameBytes(a.labels, b.labels));
  EXPECT_TRUE(sameBytes(a.colour, b.colour));
}

/// Whether a place lies within a moving object's box, widened for mirrors and swinging arms.
bool inBox(const MovingObject& object, double t, const Eigen::Vector3d& p_world, double margin) {
  const Eigen::Vector3d p = object.pose(t).inverse() * p_world;
  return std::abs(p.x()) < 0.5 * object.box_size.x() + margin &&
         std::abs(p.y()) < 0.5 * object.box_size.y() + margin && p.z() > -0.1 &&
         p.z() < object.box_size.z() + 0.1;
}

/// Whether a car in the slot may cover a place: noses and tails stick out.
bool overSlot(const Slot& slot, const Eigen::Vector2d& at) {
  const Polygon polygon(slot.corners.begin(), slot.corners.end());
  return contains(polygon, at) || test::borderDistance(polygon, at) < 0.6;
}

/// Counts of pixels per kind of thing that was looked up in the garage.
struct Checked {
  int floor = 0;
  int paint = 0;
  int worn = 0;  ///< paint that is gone
  int pillars = 0;
  int parked = 0;
  int moving = 0;
};

void checkFloor(SemanticClass label, SemanticClass expected, const Eigen::Vector2d& at,
                Checked& checked) {
  if (label == SemanticClass::kFloor && expected != SemanticClass::kFloor) {
    ++checked.worn;
    return;
  }
  EXPECT_EQ(label, expected) << nameOf(static_cast<int>(label)) << " instead of "
                             << nameOf(static_cast<int>(expected)) << " at " << at.transpose();
  ++(expected == SemanticClass::kFloor ? checked.floor : checked.paint);
}

/// Looks up what a pixel says of a place; instance: as in instance label images.
void check(const Shot& shot, const test::PaintTruth& paint, SemanticClass label, int instance,
           const Eigen::Vector3d& p, Checked& checked) {
  const Garage& garage = shot.simulation().garage();
  const Eigen::Vector2d at = p.head<2>();
  if (label == SemanticClass::kVehicle && instance >= static_cast<int>(kParkedInstance)) {
    const auto slot = std::find_if(garage.slots.begin(), garage.slots.end(), [&](const Slot& s) {
      return s.id == instance - static_cast<int>(kParkedInstance);
    });
    ASSERT_NE(slot, garage.slots.end()) << instance;
    EXPECT_TRUE(slot->occupied) << slot->id;
    EXPECT_TRUE(overSlot(*slot, at)) << "slot " << slot->id << ": " << p.transpose();
    ++checked.parked;
  } else if (label == SemanticClass::kVehicle || label == SemanticClass::kPedestrian) {
    if (instance < 0) return;  // the own car
    const auto& moving = shot.scene().moving;
    const auto object = std::find_if(moving.begin(), moving.end(), [&](const MovingObject& o) {
      return static_cast<int>(o.instance) == instance;
    });
    ASSERT_NE(object, moving.end()) << instance;
    EXPECT_EQ(object->label, label);
    EXPECT_TRUE(inBox(*object, shot.t(), p, 0.25)) << instance << ": " << p.transpose();
    ++checked.moving;
  } else if (label == SemanticClass::kPillar || label == SemanticClass::kZoneMarker) {
    constexpr double kMounted = 0.12;  // m: guards and boxes on it
    EXPECT_TRUE(test::inPillar(garage, at, kMounted)) << "no pillar at " << p.transpose();
    ++checked.pillars;
  } else if (std::abs(p.z() - garage.floorHeight(at)) < 1e-3) {
    const SemanticClass expected = paint.at(at);
    if (expected == SemanticClass::kUnknown || label == SemanticClass::kWall) return;
    checkFloor(label, expected, at, checked);
  }
}

void checkCameras(const Shot& shot, Checked& seen) {
  const test::PaintTruth paint(shot.simulation().garage());
  for (int i = 0; i < 6; ++i) {
    const TruthImages truth = shot.truth(i);
    const Camera camera = shot.cameras()[static_cast<std::size_t>(i)].camera.scaled(kSmall);
    for (int y = 0; y < truth.labels.rows; y += 2) {
      for (int x = 0; x < truth.labels.cols; x += 2) {
        Eigen::Vector3d ray;
        const double depth = truth.depths.at<float>(y, x);
        if (depth <= 0.0 || depth > 15.0 || !camera.unproject({x, y}, ray)) continue;
        SCOPED_TRACE(testing::Message() << "camera " << i << ": " << x << ", " << y);
        check(shot, paint, static_cast<SemanticClass>(truth.labels.at<std::uint8_t>(y, x)),
              truth.instances.at<std::int32_t>(y, x),
              shot.T_world_cam(i) * Eigen::Vector3d(depth * ray.normalized()), seen);
      }
    }
  }
}

/// Whether a car or person on its way covers a place on the floor.
bool movesAt(const Shot& shot, SemanticClass label, const Eigen::Vector2d& at) {
  const auto& moving = shot.scene().moving;
  const double z = shot.simulation().garage().floorHeight(at);
  return std::any_of(moving.begin(), moving.end(), [&](const MovingObject& object) {
    return object.label == label && inBox(object, shot.t(), {at.x(), at.y(), z}, 0.25);
  });
}

bool inOccupiedSlot(const Garage& garage, const Eigen::Vector2d& at) {
  return std::any_of(garage.slots.begin(), garage.slots.end(),
                     [&](const Slot& slot) { return slot.occupied && overSlot(slot, at); });
}

void checkGround(const Shot& shot, Checked& seen) {
  const Garage& garage = shot.simulation().garage();
  const test::PaintTruth paint(garage);
  const cv::Mat labels = shot.ground().labels;
  const double yaw = shot.T_world_vehicle().rotation().yaw();
  const Frame2 frame{shot.T_world_vehicle().translation().head<2>(), yaw};
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      const Eigen::Vector2d at = frame * (kGroundMetresPerPx * Eigen::Vector2d(99.5 - y, 99.5 - x));
      const auto label = static_cast<SemanticClass>(labels.at<std::uint8_t>(y, x));
      const SemanticClass expected = paint.at(at);
      SCOPED_TRACE(testing::Message() << x << ", " << y);
      switch (label) {
        case SemanticClass::kVehicle:
        case SemanticClass::kPedestrian:
          ++(movesAt(shot, label, at) ? seen.moving : seen.parked);
          EXPECT_TRUE(movesAt(shot, label, at) || inOccupiedSlot(garage, at)) << at.transpose();
          break;
        case SemanticClass::kPillar:
          EXPECT_TRUE(test::inPillar(garage, at)) << at.transpose();
          ++seen.pillars;
          break;
        case SemanticClass::kWall:
        case SemanticClass::kUnknown:
        case SemanticClass::kZoneMarker:
        case SemanticClass::kGuideSign:
        case SemanticClass::kSpeedLimitSign:
        case SemanticClass::kCeiling:
          break;
        default:
          if (expected == SemanticClass::kUnknown) break;
          checkFloor(label, expected, at, seen);
      }
    }
  }
}

TEST_P(LabelImages, AgreeWithTheGarage) {
  const Shot shot(GetParam());
  Checked ahead;
  checkCameras(shot, ahead);
  EXPECT_GT(ahead.floor, 1000);
  EXPECT_GT(ahead.paint, 50);
  EXPECT_LT(ahead.worn, 0.1 * ahead.paint);
  EXPECT_GT(ahead.pillars, 20);
  EXPECT_GT(ahead.parked, 50);
  EXPECT_GT(ahead.moving, 10);
  Checked above;
  checkGround(shot, above);
  EXPECT_GT(above.floor, 5000);
  EXPECT_GT(above.paint, 500);
  EXPECT_LT(above.worn, 0.1 * above.paint);
  EXPECT_GT(above.pillars, 10);
  EXPECT_GT(above.parked, 100);
}

INSTANTIATE_TEST_SUITE_P(Drives, LabelImages, testing::ValuesIn(test::kDrives),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace parkade::sim
