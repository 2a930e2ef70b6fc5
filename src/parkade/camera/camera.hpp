// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "parkade/camera/mei.hpp"
#include "parkade/camera/ocam.hpp"
#include "parkade/camera/pinhole_equidistant.hpp"
#include "parkade/camera/pinhole_radtan.hpp"

namespace parkade {

/// The closed set of camera models.
using CameraModel = std::variant<PinholeRadtan, PinholeEquidistant, Mei, Ocam>;

/// A camera model with the size of its image. Pixel centres lie at integer coordinates: the image
/// covers [-0.5, width - 0.5) x [-0.5, height - 0.5).
class Camera {
 public:
  Camera() = default;
  Camera(CameraModel model, int width, int height);

  /// Projects a point of the camera frame (any depth unit) to a pixel. False where the point lies
  /// outside the model's valid domain (behind the camera, beyond the angle where the distortion
  /// folds back). The pixel may lie outside the image; see inImage(). d_px_d_p is 2x3, if asked.
  bool project(const Eigen::Vector3d& p_cam, Eigen::Vector2d& pixel,
               Eigen::Matrix<double, 2, 3>* d_px_d_p = nullptr) const {
    return std::visit([&](const auto& m) { return m.project(p_cam, pixel, d_px_d_p); }, model_);
  }

  /// The unit ray of a pixel; false where the model has none.
  bool unproject(const Eigen::Vector2d& pixel, Eigen::Vector3d& ray_cam) const {
    return std::visit([&](const auto& m) { return m.unproject(pixel, ray_cam); }, model_);
  }

  /// Whether a pixel lies in the image, at least margin_px away from its border.
  [[nodiscard]] bool inImage(const Eigen::Vector2d& pixel, double margin_px = 0.0) const {
    const double border = margin_px - 0.5;
    return pixel.x() >= border && pixel.y() >= border && pixel.x() < width_ - 1 - border &&
           pixel.y() < height_ - 1 - border;
  }

  /// Largest angle from the optical axis that the model projects, radians.
  [[nodiscard]] double maxAngle() const;
  /// Pixels per radian at the image centre, the mean of both axes.
  [[nodiscard]] double focalLength() const;
  [[nodiscard]] const char* modelName() const;  ///< "pinhole-radtan", "pinhole-equidistant", ...

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const CameraModel& model() const { return model_; }

  /// The same camera for an image resized by a factor (0.5: half the size; rounded to whole
  /// pixels, and each axis scaled by what that gives, as an image resize does).
  [[nodiscard]] Camera scaled(double factor) const;

 private:
  CameraModel model_;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace parkade
