// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/sign_follower.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

/// A round plate that says "10" and a hanging sign with an arrow to the left and "P", in a grey
/// world that a car drives through; the labels are those of a perfect network, or of one that frays
/// their edges.
class SignDrive : public testing::Test {
 protected:
  SignDrive() {
    PinholeEquidistant::Parameters p;
    p.fx = p.fy = 290.0;
    p.cx = 319.5;
    p.cy = 199.5;
    camera_ = Camera(PinholeEquidistant(p), 640, 400);
    Eigen::Matrix3d axes;
    axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    R_vehicle_cam_ = SO3::fromYawPitchRoll(0.3, -0.1, 0.0) * SO3(axes);
  }

  static bool ink(double right, double up) {  // over the plate's diameter, from its middle
    constexpr std::array<const char*, 7> kText = {"  #    ### ", " ##   #   #", "  #   #   #",
                                                  "  #   #   #", "  #   #   #", "  #   #   #",
                                                  " ###   ### "};
    const int column = static_cast<int>(std::floor(right / 0.06 + 5.5));
    const int row = static_cast<int>(std::floor(3.5 - up / 0.06));
    return column >= 0 && column < 11 && row >= 0 && row < 7 &&
           kText[static_cast<std::size_t>(row)][column] == '#';
  }

  static bool guideInk(double right, double up) {  // m from its middle
    constexpr std::array<const char*, 7> kP = {"####.", "#...#", "#...#", "####.",
                                               "#....", "#....", "#...."};
    const int column = static_cast<int>(std::floor((right - 0.24) / 0.035 + 2.5));
    const int row = static_cast<int>(std::floor(3.5 - up / 0.035));
    if (column >= 0 && column < 5 && row >= 0 && row < 7) {
      return kP[static_cast<std::size_t>(row)][column] == '#';
    }
    const double along = right + 0.71;  // from the arrow's point
    return along > 0.0 && along < 0.26 && std::abs(up) < (along < 0.13 ? along : 0.03);
  }

  struct Picture {
    cv::Mat image;
    cv::Mat labels;
  };
  // Both signs face who comes along x.
  [[nodiscard]] Picture see(const SE3& T_world_cam) const {
    Picture seen{cv::Mat(400, 640, CV_8UC3, cv::Scalar::all(120)),
                 cv::Mat(192, 320, CV_8UC1, cv::Scalar(0))};
    const auto at = [&](double u, double v, int& label) {
      double grey = 120.0;
      Eigen::Vector3d ray;
      if (!camera_.unproject({u, v}, ray)) return grey;
      ray = T_world_cam.rotation() * ray;
      const auto hit = [&](const Eigen::Vector3d& middle, Eigen::Vector2d& on) {
        const double s = (middle.x() - T_world_cam.translation().x()) / ray.x();
        const Eigen::Vector3d p = T_world_cam.translation() + s * ray - middle;
        on = {-p.y(), p.z()};
        return s > 0.0;
      };
      Eigen::Vector2d on;
      if (hit(guide_, on) && std::abs(on.x()) < 0.85 && std::abs(on.y()) < 0.21) {
        label = static_cast<int>(SemanticClass::kGuideSign);
        grey = guideInk(on.x(), on.y()) ? 230.0 : 60.0;
      }
      if (hit(limit_, on) && on.norm() < 0.25) {
        label = static_cast<int>(SemanticClass::kSpeedLimitSign);
        grey = on.norm() > 0.2 ? 70.0 : (ink(on.x() / 0.5, on.y() / 0.5) ? 20.0 : 220.0);
      }
      return grey;
    };
    for (int v = 0; v < 400; ++v) {
      for (int u = 0; u < 640; ++u) {
        int label = 0;
        const double grey = 0.25 * (at(u - 0.25, v - 0.25, label) + at(u + 0.25, v - 0.25, label) +
                                    at(u - 0.25, v + 0.25, label) + at(u + 0.25, v + 0.25, label));
        seen.image.at<cv::Vec3b>(v, u) = cv::Vec3b::all(static_cast<std::uint8_t>(grey));
      }
    }
    for (int v = 0; v < 192; ++v) {
      for (int u = 0; u < 320; ++u) {
        int label = 0;
        at(2.0 * u + 0.5, (v + 0.5) * 400.0 / 192.0 - 0.5, label);
        seen.labels.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(label);
      }
    }
    return seen;
  }

  // What is told of a drive of 6.5 m towards the signs.
  std::vector<FollowedSign> drive(double fray, const SignFollowerOptions& options = {}) {
    Result<ZoneTextReader> reader =
        ZoneTextReader::load(std::string(PARKADE_SOURCE_DIR) + "/models/zone_text.yaml");
    EXPECT_TRUE(reader) << reader.error().message;
    SignFollower follower(options);
    Random random(8);
    std::vector<FollowedSign> all;
    for (int k = 0; k < 14; ++k) {
      const SE3 T_world_cam(R_vehicle_cam_, {0.5 * k, 0.2, 1.0});
      Picture seen = see(T_world_cam);
      const cv::Mat before = seen.labels.clone();
      for (int v = 0; v + 1 < before.rows; ++v) {
        for (int u = 0; u + 1 < before.cols; ++u) {
          if (!random.chance(fray)) continue;
          const cv::Point from = random.chance(0.5) ? cv::Point(u + 1, v) : cv::Point(u, v + 1);
          seen.labels.at<std::uint8_t>(v, u) = before.at<std::uint8_t>(from);
        }
      }
      const Status added = follower.add(seen.labels, seen.image, {}, camera_, T_world_cam,
                                        k * TimeNs{200000000}, *reader);
      EXPECT_TRUE(added) << added.error().message;
      for (const FollowedSign& told : follower.takeTold()) all.push_back(told);
    }
    return all;
  }

  Camera camera_;
  SO3 R_vehicle_cam_;
  Eigen::Vector3d guide_{9.0, 1.5, 2.3};
  Eigen::Vector3d limit_{8.0, 4.0, 2.0};
};

TEST_F(SignDrive, SignsArePlacedAndRead) {
  for (const double fray : {0.0, 0.4}) {
    int guides = 0;
    int limits = 0;
    std::string text;
    std::string meaning;
    for (const FollowedSign& told : drive(fray)) {
      const bool limit = told.semantic_class == SemanticClass::kSpeedLimitSign;
      const Eigen::Vector3d error = told.sign.position - (limit ? limit_ : guide_);
      ++(limit ? limits : guides);
      EXPECT_LT(error.norm(), 0.45) << error.transpose();
      // Honest to 99.9 % of chi-square with 3 degrees.
      EXPECT_LT(error.dot(told.sign.covariance.inverse() * error), 16.27) << error.transpose();
      (limit ? text : meaning) = told.sign.text;
    }
    EXPECT_GE(guides, 1) << fray;
    EXPECT_GE(limits, 1) << fray;
    // Frayed edges may cost a text, but make no other one.
    EXPECT_TRUE(text == "10" || (fray > 0.0 && text.empty())) << fray << " " << text;
    EXPECT_TRUE(meaning == "parking_left" || (fray > 0.0 && meaning.empty())) << fray << meaning;
  }
}

// A garage whose limits are others holds no sign of that one: it was misread.
TEST_F(SignDrive, LimitsThatThereAreNoneOfAreNotRead) {
  SignFollowerOptions options;
  options.limits = "30 50";
  int limits = 0;
  for (const FollowedSign& told : drive(0.0, options)) {
    if (told.semantic_class != SemanticClass::kSpeedLimitSign) continue;
    ++limits;
    EXPECT_EQ(told.sign.text, "");
  }
  EXPECT_GT(limits, 0);
}

}  // namespace
}  // namespace parkade
