// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/camera/camera.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/check.hpp"

namespace parkade {

Camera::Camera(CameraModel model, int width, int height)
    : model_(std::move(model)), width_(width), height_(height) {
  PARKADE_CHECK(width > 0 && height > 0, "image size {} x {}", width, height);
}

double Camera::maxAngle() const {
  return std::visit([](const auto& m) { return m.maxAngle(); }, model_);
}

double Camera::focalLength() const {
  return std::visit([](const auto& m) { return m.focalLength(); }, model_);
}

const char* Camera::modelName() const {
  return std::visit([](const auto& m) { return std::decay_t<decltype(m)>::kName; }, model_);
}

Camera Camera::scaled(double factor) const {
  PARKADE_CHECK(factor > 0.0, "factor {}", factor);
  const int width = std::max(1, static_cast<int>(std::lround(width_ * factor)));
  const int height = std::max(1, static_cast<int>(std::lround(height_ * factor)));
  // Of the rounded size, as an image that is resized to it has them.
  const double factor_x = static_cast<double>(width) / width_;
  const double factor_y = static_cast<double>(height) / height_;
  return {
      std::visit([&](const auto& m) { return CameraModel(m.scaled(factor_x, factor_y)); }, model_),
      width, height};
}

}  // namespace parkade
