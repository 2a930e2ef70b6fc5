// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/level_views.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {

LevelView levelView(const cv::Mat& labels, const cv::Mat& mask, const Camera& camera,
                    const SE3& T_level_cam) {
  PARKADE_CHECK(!labels.empty() && labels.type() == CV_8UC1, "labels of type {}", labels.type());
  PARKADE_CHECK(mask.empty() || (mask.cols == camera.width() && mask.rows == camera.height()),
                "a mask of {} x {} px", mask.cols, mask.rows);
  constexpr double kBearingStep = M_PI / 180.0;
  constexpr double kSlopeBegin = -0.51;
  constexpr double kSlopeStep = 0.03;
  constexpr int kSlopes = 45;
  constexpr double kLevelEnough = 0.5;  // of the optical axis, else it has no bearing to speak of
  LevelView view;
  view.eye = T_level_cam.translation();
  view.bearing_step = kBearingStep;
  view.slope_begin = kSlopeBegin;
  view.slope_step = kSlopeStep;
  const Eigen::Matrix3d R_level_cam = T_level_cam.rotation().matrix();
  const Eigen::Matrix3d R_cam_level = R_level_cam.transpose();
  const Eigen::Vector3d axis = R_level_cam.col(2);
  const bool ahead = axis.head<2>().norm() > kLevelEnough;
  const double half = ahead ? std::min(M_PI, camera.maxAngle()) : M_PI;
  const int reach = static_cast<int>(half / kBearingStep);
  const int columns =
      std::min(2 * reach + 1, static_cast<int>(std::lround(2.0 * M_PI / kBearingStep)));
  view.bearing_begin = (ahead ? std::atan2(axis.y(), axis.x()) : 0.0) - reach * kBearingStep;
  view.labels = cv::Mat(kSlopes, columns, CV_8UC1, cv::Scalar(LevelView::kNotSeen));
  const double scale_x = static_cast<double>(labels.cols) / camera.width();
  const double scale_y = static_cast<double>(labels.rows) / camera.height();
  for (int column = 0; column < columns; ++column) {
    const double bearing = view.bearing_begin + column * kBearingStep;
    const Eigen::Vector3d level =
        R_cam_level * Eigen::Vector3d(std::cos(bearing), std::sin(bearing), 0.0);
    for (int row = 0; row < kSlopes; ++row) {
      const double slope = kSlopeBegin + row * kSlopeStep;
      Eigen::Vector2d pixel;
      if (!camera.project(level + slope * R_cam_level.col(2), pixel) || !camera.inImage(pixel))
        continue;
      if (!mask.empty() &&
          mask.at<std::uint8_t>(static_cast<int>(std::floor(pixel.y() + 0.5)),
                                static_cast<int>(std::floor(pixel.x() + 0.5))) == 0) {
        continue;
      }
      const int u = std::clamp(static_cast<int>((pixel.x() + 0.5) * scale_x), 0, labels.cols - 1);
      const int v = std::clamp(static_cast<int>((pixel.y() + 0.5) * scale_y), 0, labels.rows - 1);
      view.labels.at<std::uint8_t>(row, column) = labels.at<std::uint8_t>(v, u);
    }
  }
  return view;
}

}  // namespace parkade
