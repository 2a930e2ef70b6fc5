// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/bev/ground_table.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

constexpr float kNowhere = -1.0e6F;

// Everything the table keeps of one bird's-eye pixel.
struct Entry {
  bool covered = false;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 3> d_pixel_d_attitude = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> d_pixel_d_motion = Eigen::Matrix<double, 2, 3>::Zero();
  double weight = 0.0;
};

// Distance in pixels from the image's border, negative outside.
double borderDistance(const Camera& camera, const Eigen::Vector2d& pixel) {
  return std::min({pixel.x() + 0.5, pixel.y() + 0.5, camera.width() - 0.5 - pixel.x(),
                   camera.height() - 0.5 - pixel.y()});
}

Entry makeEntry(const RigCamera& rig_camera, const Eigen::Vector2d& ground, double border_px,
                double max_range) {
  Entry entry;
  const Eigen::Vector3d p_ground(ground.x(), ground.y(), 0.0);
  const SE3 T_cam_vehicle = rig_camera.T_vehicle_cam.inverse();
  const Eigen::Vector3d p_cam = T_cam_vehicle * p_ground;
  Eigen::Matrix<double, 2, 3> d_pixel_d_cam;
  if (!rig_camera.camera.project(p_cam, entry.pixel, &d_pixel_d_cam)) return entry;
  const double border = borderDistance(rig_camera.camera, entry.pixel) - border_px;
  const Eigen::Vector3d& eye = rig_camera.T_vehicle_cam.translation();
  const double range = (ground - eye.head<2>()).norm();
  if (border <= 0.0 || range > max_range || eye.z() <= 0.0) return entry;
  entry.covered = true;

  // Equation (3): p_vehicle = R^T (p_ground - h e_z), R = Ry(pitch) Rx(roll); at zero attitude the
  // derivatives are -e_y x p, -e_x x p and -e_z.
  Eigen::Matrix3d d_vehicle_d_attitude;
  d_vehicle_d_attitude.col(0) = -Eigen::Vector3d::UnitY().cross(p_ground);
  d_vehicle_d_attitude.col(1) = -Eigen::Vector3d::UnitX().cross(p_ground);
  d_vehicle_d_attitude.col(2) = -Eigen::Vector3d::UnitZ();
  const Eigen::Matrix<double, 2, 3> d_pixel_d_vehicle =
      d_pixel_d_cam * T_cam_vehicle.rotation().matrix();
  entry.d_pixel_d_attitude = d_pixel_d_vehicle * d_vehicle_d_attitude;

  // Equation (4b): until its row is read the point comes nearer by (v + w e_z x p) times that long.
  if (rig_camera.readout_time > 0.0) {
    Eigen::Matrix3d d_vehicle_d_motion;
    d_vehicle_d_motion.col(0) = -Eigen::Vector3d::UnitX();
    d_vehicle_d_motion.col(1) = -Eigen::Vector3d::UnitY();
    d_vehicle_d_motion.col(2) = -Eigen::Vector3d::UnitZ().cross(p_ground);
    const double share = rowTimeOf(1.0, entry.pixel.y(), rig_camera.camera.height());
    entry.d_pixel_d_motion = share * d_pixel_d_vehicle * d_vehicle_d_motion;
  }

  // Equation (4): image pixels per metre along the line of sight fall with the square of the slant
  // range; the border fades over an eighth of the image's height.
  const double slant2 = (range * range + eye.z() * eye.z()) / (eye.z() * eye.z());
  const double fade = std::min(1.0, border / (0.125 * rig_camera.camera.height()));
  entry.weight = fade * fade * (3.0 - 2.0 * fade) / slant2;
  return entry;
}

}  // namespace

cv::Mat reliefPicture(const GroundRelief& relief, const BevGeometry& geometry) {
  cv::Mat picture;
  if (relief.isFlat()) return picture;
  cv::Mat nodes(static_cast<int>(relief.heights.rows()), static_cast<int>(relief.heights.cols()),
                CV_32FC1);
  for (int i = 0; i < nodes.rows; ++i) {
    for (int j = 0; j < nodes.cols; ++j) {
      nodes.at<float>(i, j) = static_cast<float>(relief.heights(i, j));
    }
  }
  // The picture's rows run against x, along which the nodes' rows lie; columns and y likewise.
  const double scale = -geometry.metres_per_px / relief.step_m;
  const Eigen::Vector2d corner =
      (geometry.toGround(Eigen::Vector2d::Zero()) - relief.first) / relief.step_m;
  const cv::Matx23d node_of_pixel(scale, 0.0, corner.y(), 0.0, scale, corner.x());
  cv::warpAffine(nodes, picture, node_of_pixel, cv::Size(geometry.width_px, geometry.height_px),
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return picture;
}

GroundTable::GroundTable(const RigCamera& camera, const BevGeometry& geometry, double border_px,
                         double max_range)
    : readout_time_(camera.readout_time) {
  PARKADE_CHECK(geometry.width_px > 0 && geometry.height_px > 0 && geometry.metres_per_px > 0.0,
                "bird's-eye picture of {} x {} at {} m", geometry.width_px, geometry.height_px,
                geometry.metres_per_px);
  const int rows = geometry.height_px;
  const int cols = geometry.width_px;
  std::vector<Entry> entries(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols));
  int left = cols;
  int right = -1;
  int top = rows;
  int bottom = -1;
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      Entry entry =
          makeEntry(camera, geometry.toGround(Eigen::Vector2d(u, v)), border_px, max_range);
      if (entry.covered) {
        left = std::min(left, u);
        right = std::max(right, u);
        top = std::min(top, v);
        bottom = std::max(bottom, v);
      }
      entries[static_cast<std::size_t>(v) * static_cast<std::size_t>(cols) +
              static_cast<std::size_t>(u)] = entry;
    }
  }
  if (right < 0) return;
  roi_ = cv::Rect(left, top, right - left + 1, bottom - top + 1);
  weight_ = cv::Mat::zeros(roi_.size(), CV_32FC1);
  for (int axis = 0; axis < 2; ++axis) {
    base_[axis] = cv::Mat(roi_.size(), CV_32FC1, cv::Scalar(kNowhere));
    for (cv::Mat& derivative : derivative_[axis])
      derivative = cv::Mat::zeros(roi_.size(), CV_32FC1);
    if (camera.readout_time <= 0.0) continue;
    for (cv::Mat& derivative : by_motion_[axis]) derivative = cv::Mat::zeros(roi_.size(), CV_32FC1);
  }
  for (int v = 0; v < roi_.height; ++v) {
    for (int u = 0; u < roi_.width; ++u) {
      const Entry& entry =
          entries[static_cast<std::size_t>(v + top) * static_cast<std::size_t>(cols) +
                  static_cast<std::size_t>(u + left)];
      if (!entry.covered) continue;
      weight_.at<float>(v, u) = static_cast<float>(entry.weight);
      for (int axis = 0; axis < 2; ++axis) {
        base_[axis].at<float>(v, u) = static_cast<float>(entry.pixel[axis]);
        for (int k = 0; k < 3; ++k) {
          derivative_[axis][k].at<float>(v, u) =
              static_cast<float>(entry.d_pixel_d_attitude(axis, k));
          if (by_motion_[axis][k].empty()) continue;
          by_motion_[axis][k].at<float>(v, u) = static_cast<float>(entry.d_pixel_d_motion(axis, k));
        }
      }
    }
  }
}

void GroundTable::hide(const cv::Mat& mask) {
  PARKADE_CHECK(mask.type() == CV_8UC1, "mask of type {}", mask.type());
  if (roi_.empty()) return;
  constexpr float kNear = 2.0F;  // px from the outline that are left out
  const float full = kNear + 0.04F * static_cast<float>(mask.rows);
  cv::Mat distance;
  // The image's border is no outline: the table fades there by itself.
  cv::distanceTransform(mask != 0, distance, cv::DIST_L2, cv::DIST_MASK_3);
  for (int v = 0; v < roi_.height; ++v) {
    for (int u = 0; u < roi_.width; ++u) {
      float& weight = weight_.at<float>(v, u);
      if (weight <= 0.0F) continue;
      const int x = cvRound(base_[0].at<float>(v, u));
      const int y = cvRound(base_[1].at<float>(v, u));
      const bool inside = x >= 0 && y >= 0 && x < mask.cols && y < mask.rows;
      const float far = inside ? distance.at<float>(y, x) : 0.0F;
      const float fade = std::clamp((far - kNear) / (full - kNear), 0.0F, 1.0F);
      weight *= fade * fade * (3.0F - 2.0F * fade);
    }
  }
}

void GroundTable::mapFor(const GroundAttitude& attitude, const cv::Mat& relief,
                         const GroundMotion& motion, cv::Mat& map_x, cv::Mat& map_y) const {
  const float change[3] = {static_cast<float>(attitude.pitch), static_cast<float>(attitude.roll),
                           static_cast<float>(attitude.height)};
  const float going[3] = {static_cast<float>(readout_time_ * motion.velocity.x()),
                          static_cast<float>(readout_time_ * motion.velocity.y()),
                          static_cast<float>(readout_time_ * motion.yaw_rate)};
  cv::Mat* maps[2] = {&map_x, &map_y};
  for (int axis = 0; axis < 2; ++axis) {
    maps[axis]->create(roi_.size(), CV_32FC1);
    for (int v = 0; v < roi_.height; ++v) {
      const float* base = base_[axis].ptr<float>(v);
      const float* d0 = derivative_[axis][0].ptr<float>(v);
      const float* d1 = derivative_[axis][1].ptr<float>(v);
      const float* d2 = derivative_[axis][2].ptr<float>(v);
      float* out = maps[axis]->ptr<float>(v);
      for (int u = 0; u < roi_.width; ++u) {
        out[u] = base[u] + d0[u] * change[0] + d1[u] * change[1] + d2[u] * change[2];
      }
      if (!by_motion_[axis][0].empty()) {
        const float* m0 = by_motion_[axis][0].ptr<float>(v);
        const float* m1 = by_motion_[axis][1].ptr<float>(v);
        const float* m2 = by_motion_[axis][2].ptr<float>(v);
        for (int u = 0; u < roi_.width; ++u) {
          out[u] += m0[u] * going[0] + m1[u] * going[1] + m2[u] * going[2];
        }
      }
      if (relief.empty()) continue;
      // Floor that lies higher is as a body that stands lower.
      const float* rise = relief.ptr<float>(v + roi_.y) + roi_.x;
      for (int u = 0; u < roi_.width; ++u) out[u] -= d2[u] * rise[u];
    }
  }
}

}  // namespace parkade
