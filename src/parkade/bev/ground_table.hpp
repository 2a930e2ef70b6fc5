// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "parkade/camera/rig.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/ground_relief.hpp"

namespace parkade {

/// The relief at each pixel of a picture, m, CV_32FC1, as GroundTable::mapFor takes it; empty where
/// the floor is flat.
cv::Mat reliefPicture(const GroundRelief& relief, const BevGeometry& geometry);

/// Inverse perspective mapping of one camera: for each bird's-eye pixel that it sees, the image
/// point, and how that point moves with the body's attitude. docs/math/ipm.md, eqs. (1) to (4).
///
/// The table is exact at the attitude it was made for and of first order around it: at half a
/// degree the image point is off by about f * 0.0087^2 / 2, 0.01 px for f = 300 px.
class GroundTable {
 public:
  /// Pixels whose image point lies less than border_px inside the image, or further than max_range
  /// metres from the camera's foot, are left out.
  GroundTable(const RigCamera& camera, const BevGeometry& geometry, double border_px,
              double max_range);

  /// Bounding box of the covered pixels, in the bird's-eye picture; empty where none is.
  [[nodiscard]] const cv::Rect& roi() const { return roi_; }

  /// The blending weight of each pixel of roi(): CV_32FC1, 0 where not covered. Falls with the
  /// distance over the height (grazing view, few image pixels per metre) and to 0 at the border.
  [[nodiscard]] const cv::Mat& weight() const { return weight_; }

  /// Leaves out what the own body hides: mask is CV_8UC1 of the image's size, 0 where it does. The
  /// weight falls to 0 towards the body's outline, whose blurred edge is no ground either.
  void hide(const cv::Mat& mask);

  /// A rolling shutter takes longer or less long than the camera was told to, s.
  void setReadoutTime(double seconds) { readout_time_ = seconds; }

  /// Image points for an attitude, as cv::remap takes them: CV_32FC1 each, of roi()'s size; far
  /// outside the image where not covered. relief: reliefPicture() of the whole picture.
  /// motion: counts where the camera has a rolling shutter alone; ipm.md, eq. (4b).
  void mapFor(const GroundAttitude& attitude, const cv::Mat& relief, const GroundMotion& motion,
              cv::Mat& map_x, cv::Mat& map_y) const;

 private:
  cv::Rect roi_;
  cv::Mat weight_;
  cv::Mat base_[2];           ///< image point at attitude zero: x, y
  cv::Mat derivative_[2][3];  ///< of x, y by pitch, roll, height
  double readout_time_;       ///< s
  /// Of x, y by velocity's x, y and yaw rate, per second of readout time; empty where there is
  /// none.
  cv::Mat by_motion_[2][3];
};

}  // namespace parkade
