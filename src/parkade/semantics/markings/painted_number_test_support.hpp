// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "parkade/camera/rig.hpp"
#include "parkade/semantics/features_test_support.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// A slot with "47" painted behind its entrance, left of a car that looks along x.
struct NumberedSlot {
  static constexpr double kCell = 0.08;  // m; letters have 5 x 7 cells
  static constexpr double kWidth = 11 * kCell;
  static constexpr double kHeight = 7 * kCell;

  /// The number's middle; the entrance lies half a metre before it, on the side of the car.
  Eigen::Vector2d center{1.5, 3.0};
  double turn = 0.0;    ///< rad, of the slot about the number's middle
  bool leaves = false;  ///< painted for who leaves the slot
  double ring = 0.0;    ///< m, radius of a ring around it, which makes it a speed limit; 0: none

  /// In the slot's axes: to the right, as seen from the entrance, and into it.
  [[nodiscard]] Eigen::Vector2d right() const { return {std::cos(turn), std::sin(turn)}; }
  [[nodiscard]] Eigen::Vector2d up() const { return {-std::sin(turn), std::cos(turn)}; }
  [[nodiscard]] Eigen::Vector2d at(double x, double y) const {
    return center + x * right() + y * up();
  }

  [[nodiscard]] bool inked(const Eigen::Vector2d& p) const {
    const double far = (p - center).norm();
    if (far < ring && far > 0.86 * ring) return true;
    constexpr std::array<const char*, 7> kText = {"   #  #####", "  ##      #", " # #     # ",
                                                  "#  #    #  ", "#####  #   ", "   #   #   ",
                                                  "   #   #   "};
    const double sign = leaves ? -1.0 : 1.0;
    const double x = sign * right().dot(p - center) + 0.5 * kWidth;
    const double y = 0.5 * kHeight - sign * up().dot(p - center);
    const int column = static_cast<int>(std::floor(x / kCell));
    const int row = static_cast<int>(std::floor(y / kCell));
    return column >= 0 && column < 11 && row >= 0 && row < 7 &&
           kText[static_cast<std::size_t>(row)][column] == '#';
  }

  /// What a perfect network and extractor make of it.
  [[nodiscard]] SemanticFrame frame() const {
    PaintedFloor floor;
    floor.paint([&](const Eigen::Vector2d& p) { return inked(p); }, SemanticClass::kPaintedNumber,
                190, PaintedFloor::around({center}, 0.8));
    SemanticFrame frame;
    frame.labels = floor.labels;
    SlotObservation slot;
    slot.corners = {at(-1.25, -0.8), at(1.25, -0.8), at(1.25, 4.2), at(-1.25, 4.2)};
    frame.slots = {slot};
    ObjectObservation object;
    object.semantic_class = SemanticClass::kPaintedNumber;
    object.position << center, 0.0;
    const double x = 0.5 * kWidth;
    const double y = 0.5 * kHeight;
    object.outline = {at(-x, -y), at(x, -y), at(x, y), at(-x, y)};
    frame.objects = {object};
    if (ring > 0.0) asLimit(frame);
    return frame;
  }

  void asLimit(SemanticFrame& frame) const {
    frame.slots.clear();
    ObjectObservation& object = frame.objects.front();
    object.semantic_class = SemanticClass::kSpeedLimitPaint;
    object.outline.clear();
    for (int k = 0; k < 16; ++k) {
      const double angle = 2.0 * M_PI * k / 16;
      object.outline.push_back(at(ring * std::cos(angle), ring * std::sin(angle)));
    }
  }

  /// The floor that a pixel shows; false where it shows none.
  static bool floorAt(const RigCamera& camera, const Eigen::Vector2d& pixel, Eigen::Vector2d& p) {
    Eigen::Vector3d ray;
    if (!camera.camera.unproject(pixel, ray)) return false;
    ray = camera.T_vehicle_cam.rotation() * ray;
    if (ray.z() > -1e-3) return false;
    const Eigen::Vector3d eye = camera.T_vehicle_cam.translation();
    p = (eye - eye.z() / ray.z() * ray).head<2>();
    return true;
  }
  [[nodiscard]] bool isNear(const RigCamera& camera, const Eigen::Vector2d& pixel) const {
    constexpr double kAround = 1.2;  // m, all that is sampled
    Eigen::Vector2d p;
    return floorAt(camera, pixel, p) && (p - center).norm() < kAround;
  }

  /// The floor around it as a camera sees it, with grey noise of this sigma; plain elsewhere.
  [[nodiscard]] cv::Mat see(const RigCamera& camera, double noise, Random& random) const {
    cv::Mat image(camera.camera.height(), camera.camera.width(), CV_8UC3, cv::Scalar::all(80));
    constexpr int kSub = 3;
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        if (!isNear(camera, {u, v})) continue;
        int hits = 0;
        for (int k = 0; k < kSub * kSub; ++k) {
          const Eigen::Vector2d pixel(u + (k % kSub - 1.0) / kSub, v + (k / kSub - 1.0) / kSub);
          Eigen::Vector2d p;
          hits += floorAt(camera, pixel, p) && inked(p) ? 1 : 0;
        }
        const double grey = 80.0 + 90.0 * hits / (kSub * kSub) + noise * random.normal();
        image.at<cv::Vec3b>(v, u) = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(grey));
      }
    }
    return image;
  }

  /// A camera on the car's left side that looks down at the floor beside it.
  static RigCamera camera() {
    PinholeEquidistant::Parameters p;
    p.fx = p.fy = 290.0;
    p.cx = 319.5;
    p.cy = 199.5;
    RigCamera camera;
    camera.name = "cam0";
    camera.camera = Camera(PinholeEquidistant(p), 640, 400);
    Eigen::Matrix3d left;  // looks along +y of the vehicle
    left << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    camera.T_vehicle_cam = SE3(SO3(left) * SO3::exp({-0.4, 0.0, 0.0}), {1.5, 0.9, 1.1});
    return camera;
  }
};

}  // namespace parkade
