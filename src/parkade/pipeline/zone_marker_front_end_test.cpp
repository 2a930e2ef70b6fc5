// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/zone_marker_front_end.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>

#include "parkade/semantics/networks/class_map.hpp"

namespace parkade {
namespace {

using testing::HasSubstr;

const std::string kSource = PARKADE_SOURCE_DIR;

/// A bright plate that says "E2" on the wall of a grey world, seen by one camera of a car that
/// drives past; the labels are those of the network that tells by brightness alone.
class ZoneMarkerDrive : public testing::Test {
 protected:
  static constexpr double kWidth = 0.7;
  static constexpr double kHeight = 0.6;

  ZoneMarkerDrive()
      : folder_(std::filesystem::temp_directory_path() /
                (std::string("parkade_zone_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
    PinholeEquidistant::Parameters p;
    p.fx = p.fy = 290.0;
    p.cx = 319.5;
    p.cy = 199.5;
    RigCamera camera;
    camera.name = "cam0";
    camera.camera = Camera(PinholeEquidistant(p), 640, 400);
    Eigen::Matrix3d left;  // looks along +y of the vehicle
    left << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    camera.T_vehicle_cam = SE3(SO3(left), {1.5, 0.9, 1.0});
    rig_.cameras = {camera};
    options_.network = (folder_ / "bright.yaml").string();
    std::ofstream(options_.network)
        << "network: " << kSource << "/tests/data/networks/bright.onnx\n"
        << "input: {width: 320, height: 192, any_size: true, mean: 127.5, scale: 0.00784314}\n"
        << "classes: [wall, unknown, zone_marker]\n";
  }
  ~ZoneMarkerDrive() override { std::filesystem::remove_all(folder_); }

  // Letters in cells of 5 x 7 on a plate of 15 x 13.
  static bool ink(double across, double up) {
    constexpr std::array<const char*, 7> kText = {"#####  ### ", "#     #   #", "#         #",
                                                  "####     # ", "#       #  ", "#      #   ",
                                                  "##### #####"};
    const int column = static_cast<int>(std::floor(across * 15.0)) - 2;
    const int row = static_cast<int>(std::floor((1.0 - up) * 13.0)) - 3;
    return column >= 0 && column < 11 && row >= 0 && row < 7 &&
           kText[static_cast<std::size_t>(row)][column] == '#';
  }

  // The plate stands in the plane y = marker.y and faces the road.
  [[nodiscard]] FrameSet see(const SE3& T_world_vehicle) const {
    const RigCamera& camera = rig_.cameras[0];
    const SE3 T_world_cam = T_world_vehicle * camera.T_vehicle_cam;
    cv::Mat image(400, 640, CV_8UC3, cv::Scalar::all(120));
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        Eigen::Vector3d ray;
        if (!camera.camera.unproject({u, v}, ray)) continue;
        ray = T_world_cam.rotation() * ray;
        const double s = (marker_.y() - T_world_cam.translation().y()) / ray.y();
        const Eigen::Vector3d p = T_world_cam.translation() + s * ray;
        const double across = (p.x() - marker_.x()) / kWidth + 0.5;
        const double up = (p.z() - marker_.z()) / kHeight + 0.5;
        if (s < 0.0 || across < 0.0 || across > 1.0 || up < 0.0 || up > 1.0) continue;
        const double grey = ink(across, up) ? 205.0 : 250.0;
        image.at<cv::Vec3b>(v, u) = cv::Vec3b::all(static_cast<std::uint8_t>(grey));
      }
    }
    FrameSet frames;
    frames.images = {image};
    return frames;
  }

  [[nodiscard]] Result<std::unique_ptr<ZoneMarkerFrontEnd>> create() const {
    return ZoneMarkerFrontEnd::create(rig_, std::vector<cv::Mat>(rig_.cameras.size()), options_);
  }

  std::filesystem::path folder_;
  Rig rig_;
  ZoneMarkerFrontEndOptions options_;
  Eigen::Vector3d marker_{6.0, 5.0, 1.7};
};

TEST_F(ZoneMarkerDrive, PlacesAndReadsAMarkerThatIsPassed) {
  const auto front_end = create();
  ASSERT_TRUE(front_end) << front_end.error().message;
  ASSERT_NE(*front_end, nullptr);
  std::vector<Eigen::Vector3d> places;
  for (int k = 0; k < 16; ++k) {
    PoseEstimate odometry;
    odometry.t_ns = k * TimeNs{100000000};
    odometry.T_odom_vehicle = SE3(SO3::exp({0.0, 0.0, 0.02 * k}), {0.4 * k, 0.1, 0.0});
    FrameSet frames = see(odometry.T_odom_vehicle);
    frames.t_ns = odometry.t_ns;
    const auto found = (*front_end)->look(frames, odometry, {0.0, 0.0, 0.0});
    ASSERT_TRUE(found) << found.error().message;
    // The labels that it saw are there for others, in the levelled vehicle frame.
    ASSERT_EQ((*front_end)->views().size(), 1U);
    const LevelView& view = (*front_end)->views()[0];
    const Eigen::Vector3d plate = odometry.T_odom_vehicle.inverse() * marker_;
    if (std::abs(plate.x() - 1.5) < 3.0) {
      EXPECT_EQ(view.at(plate), static_cast<int>(SemanticClass::kZoneMarker)) << k;
      EXPECT_NE(view.at(plate + Eigen::Vector3d(0.8, 0.0, 0.0)),
                static_cast<int>(SemanticClass::kZoneMarker));
    }
    for (const ObjectObservation& o : *found) {
      EXPECT_EQ(o.semantic_class, SemanticClass::kZoneMarker);
      EXPECT_EQ(o.text, "E2");
      EXPECT_GT(o.confidence, 0.9);
      EXPECT_LT(std::sqrt(o.covariance.topLeftCorner<2, 2>().trace()), 0.5);
      places.emplace_back(odometry.T_odom_vehicle * o.position);
    }
  }
  ASSERT_FALSE(places.empty());
  for (const Eigen::Vector3d& place : places) {
    EXPECT_LT((place - marker_).norm(), 0.25) << place.transpose();
  }
}

TEST_F(ZoneMarkerDrive, SwitchedOffAndWrongFiles) {
  options_.enabled = false;
  auto front_end = create();
  ASSERT_TRUE(front_end);
  EXPECT_EQ(*front_end, nullptr);

  options_.enabled = true;
  options_.reader = (folder_ / "none.yaml").string();
  front_end = create();
  ASSERT_FALSE(front_end);
  EXPECT_THAT(front_end.error().message, HasSubstr("none.yaml"));

  options_.reader.clear();
  options_.network = (folder_ / "none.yaml").string();
  front_end = create();
  ASSERT_FALSE(front_end);
  EXPECT_THAT(front_end.error().message, HasSubstr("none.yaml"));

  // Without a network for views there is no search, and no failure.
  options_.network.clear();
  front_end = create();
  ASSERT_TRUE(front_end);
  EXPECT_EQ(*front_end != nullptr, static_cast<bool>(findModel("view_segmentation")));
}

}  // namespace
}  // namespace parkade
