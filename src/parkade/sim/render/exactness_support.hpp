// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests that pictures agree with the camera models: cameras of every model, and corners found
// in pictures to a fraction of a pixel.
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <ostream>

#include "parkade/sim/render/renderer.hpp"
#include "parkade/sim/render/texture.hpp"

namespace parkade::sim::test {

struct Model {
  const char* name;
  Camera (*make)();
};
inline std::ostream& operator<<(std::ostream& stream, const Model& model) {
  return stream << model.name;
}

inline Camera radtan() {
  PinholeRadtan::Parameters p;
  p.fx = 300.0;
  p.fy = 305.0;
  p.cx = 322.3;
  p.cy = 196.1;
  p.distortion = {-0.18, 0.03, 0.0007, -0.0004};
  return {CameraModel(PinholeRadtan(p)), 640, 400};
}
inline Camera equidistant() {
  PinholeEquidistant::Parameters p;
  p.fx = 230.0;
  p.fy = 231.0;
  p.cx = 318.2;
  p.cy = 203.4;
  p.k1 = 0.02;
  p.k2 = -0.006;
  return {CameraModel(PinholeEquidistant(p)), 640, 400};
}
inline Camera mei() {
  Mei::Parameters p;
  p.xi = 1.3;
  p.gamma1 = 560.0;
  p.gamma2 = 558.0;
  p.u0 = 321.0;
  p.v0 = 199.0;
  p.distortion = {-0.12, 0.02, 0.0003, 0.0002};
  return {CameraModel(Mei(p)), 640, 400};
}
inline Camera ocam() {
  Ocam::Parameters p;
  p.world2cam = {627.927477776227, 466.028077028629,  -2.8986629308847,  24.2220612718414,
                 72.6950631423446, -33.3800489422008, -23.5185216191834, 114.225279210139,
                 139.347809599797, 61.1223487329993,  9.684055492906211};
  p.affine << 0.999838380441138, 0.0004930391795583601, 0.0002399186063006992, 1.0;
  p.cx = 648.5992811830847;
  p.cy = 481.3627675101494;
  return Camera(CameraModel(Ocam(p)), 1280, 960).scaled(0.5);
}

inline const std::array<Model, 4>& models() {
  static const std::array<Model, 4> kModels{Model{"Radtan", &radtan},
                                            Model{"Equidistant", &equidistant}, Model{"Mei", &mei},
                                            Model{"Ocam", &ocam}};
  return kModels;
}

inline RenderOptions quietOptions(bool fast) {
  RenderOptions options;
  options.fast = fast;
  options.reflections = false;
  options.threads = 1;
  options.sensor.noise = false;
  options.sensor.vignetting = false;
  options.sensor.fixed_exposure_ms = 10.0;
  options.sensor.fixed_gain = 4.0;
  options.bake.bounces = 0;
  return options;
}

/// Linear grey of a painted picture over that of the same picture without paint: the paint's
/// reflectance alone, free of the light's gradients.
inline cv::Mat paintOnly(const cv::Mat& painted, const cv::Mat& plain) {
  cv::Mat ratio(painted.size(), CV_32FC1);
  for (int y = 0; y < ratio.rows; ++y) {
    for (int x = 0; x < ratio.cols; ++x) {
      ratio.at<float>(y, x) = linearOfSrgb(painted.at<cv::Vec3b>(y, x)[1]) /
                              std::max(linearOfSrgb(plain.at<cv::Vec3b>(y, x)[1]), 1e-3F);
    }
  }
  return ratio;
}

/// Value of a CV_32FC1 picture between pixels (bilinear).
inline double greyAt(const cv::Mat& image, const Eigen::Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x()));
  const int y = static_cast<int>(std::floor(p.y()));
  const double ax = p.x() - x;
  const double ay = p.y() - y;
  const auto at = [&](int px, int py) { return static_cast<double>(image.at<float>(py, px)); };
  return (1 - ay) * ((1 - ax) * at(x, y) + ax * at(x + 1, y)) +
         ay * ((1 - ax) * at(x, y + 1) + ax * at(x + 1, y + 1));
}

/// How far the edge found along the normal lies from the place given, px: from the area below the
/// profile between its plateaus.
inline double edgeOffset(const cv::Mat& image, const Eigen::Vector2d& p,
                         const Eigen::Vector2d& normal) {
  constexpr double kReach = 3.0;
  constexpr int kSteps = 120;
  const double low = greyAt(image, p - kReach * normal);
  const double high = greyAt(image, p + kReach * normal);
  double area = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double s = -kReach + 2.0 * kReach * (i + 0.5) / kSteps;
    area += (greyAt(image, p + s * normal) - low) / (high - low) * 2.0 * kReach / kSteps;
  }
  return kReach - area;
}

/// The corner's displacement in the picture against its projection: offsets of both edges, fitted
/// as lines along them and extended to it. False where the corner cannot be
/// measured (too small, not in the picture).
inline bool cornerError(
    const cv::Mat& image,
    const std::function<bool(const Eigen::Vector2d&, Eigen::Vector2d&)>& project,
    const Eigen::Vector2d& corner, const Eigen::Vector2d& along_a, const Eigen::Vector2d& along_b,
    Eigen::Vector2d& error) {
  Eigen::Matrix2d normals;
  Eigen::Vector2d offsets;
  for (int e = 0; e < 2; ++e) {
    const Eigen::Vector2d& along = e == 0 ? along_a : along_b;
    const Eigen::Vector2d& into = e == 0 ? along_b : along_a;
    Eigen::Vector2d start;
    Eigen::Vector2d end;
    Eigen::Vector2d inside;
    if (!project(corner, start) || !project(corner + along, end) ||
        !project(corner + into, inside)) {
      return false;
    }
    const double length = (end - start).norm();
    if (length < 32.0) {  // too few pixels to fit a line to
      return false;
    }
    constexpr int kPlaces = 40;
    Eigen::MatrixXd A(kPlaces, 2);
    Eigen::VectorXd b(kPlaces);
    for (int i = 0; i < kPlaces; ++i) {
      const double margin = 6.0 / length;
      const double s = margin + (1.0 - 2.0 * margin) * i / (kPlaces - 1);
      Eigen::Vector2d p;
      Eigen::Vector2d q;
      if (!project(corner + s * along, p) || !project(corner + (s + 0.01) * along, q)) {
        return false;
      }
      const Eigen::Vector2d tangent = (q - p).normalized();
      Eigen::Vector2d normal(-tangent.y(), tangent.x());
      if (normal.dot(inside - start) < 0.0) {
        normal = -normal;
      }
      for (const double reach : {-6.0, 6.0}) {
        const Eigen::Vector2d border = p + reach * normal;
        if (border.x() < 1 || border.y() < 1 || border.x() > image.cols - 3 ||
            border.y() > image.rows - 3) {
          return false;
        }
      }
      A.row(i) << 1.0, s;
      b[i] = edgeOffset(image, p, normal);
      if (i == 0) {
        normals.row(e) = normal.transpose();
      }
    }
    offsets[e] = A.colPivHouseholderQr().solve(b)[0];
  }
  if (std::abs(normals.determinant()) < 0.4) {
    return false;
  }
  error = normals.colPivHouseholderQr().solve(offsets);
  return true;
}

}  // namespace parkade::sim::test
