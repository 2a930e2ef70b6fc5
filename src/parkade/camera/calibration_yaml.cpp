// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/camera/calibration_yaml.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <initializer_list>
#include <type_traits>

namespace parkade {
namespace {

std::vector<double> readNumbers(const YamlNode& node, std::initializer_list<std::size_t> counts,
                                const char* names) {
  std::vector<double> values = node.asDoubles();
  for (const std::size_t count : counts) {
    if (values.size() == count) return values;
  }
  node.fail(fmt::format("expected {} numbers ({}), found {}", fmt::join(counts, " or "), names,
                        values.size()));
}

template <class Parameters>
auto checked(const Parameters& parameters, const YamlNode& intrinsics) {
  const std::string problem = parameters.problem();
  if (!problem.empty()) intrinsics.fail(problem);
  return parameters;
}

RadtanDistortion readRadtan(const YamlNode& node) {
  std::vector<double> c = readNumbers(node, {4, 5, 8}, "k1 k2 p1 p2 [k3 [k4 k5 k6]]");
  c.resize(8, 0.0);
  return {c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]};
}

[[noreturn]] void failModel(const YamlNode& node, const std::string& value,
                            const std::string& known) {
  node.fail(fmt::format("unknown value '{}'; known: {}", value, known));
}

// none, with coefficients absent or empty.
void checkNoCoefficients(const YamlNode& node, const char* key) {
  if (node.has(key)) readNumbers(node.at(key), {0}, "distortion_model is none");
}

CameraModel readPinhole(const YamlNode& node, const char* key) {
  const YamlNode intrinsics = node.at("intrinsics");
  const std::vector<double> i = readNumbers(intrinsics, {4}, "fx fy cx cy");
  const YamlNode distortion = node.at("distortion_model");
  const std::string name = distortion.asString();
  if (name == "equidistant") {
    const std::vector<double> c = readNumbers(node.at(key), {4}, "k1 k2 k3 k4");
    const PinholeEquidistant::Parameters p{i[0], i[1], i[2], i[3], c[0], c[1], c[2], c[3]};
    return PinholeEquidistant(checked(p, intrinsics));
  }
  PinholeRadtan::Parameters p{i[0], i[1], i[2], i[3], {}};
  if (name == "radtan" || name == "radial-tangential") {
    p.distortion = readRadtan(node.at(key));
  } else if (name == "none") {
    checkNoCoefficients(node, key);
  } else {
    failModel(distortion, name, "radtan, equidistant, none");
  }
  return PinholeRadtan(checked(p, intrinsics));
}

CameraModel readOmni(const YamlNode& node, const char* key) {
  const YamlNode intrinsics = node.at("intrinsics");
  const std::vector<double> i = readNumbers(intrinsics, {5}, "xi gamma1 gamma2 u0 v0");
  Mei::Parameters p{i[0], i[1], i[2], i[3], i[4], {}};
  const YamlNode distortion = node.at("distortion_model");
  const std::string name = distortion.asString();
  if (name == "radtan" || name == "radial-tangential") {
    p.distortion = readRadtan(node.at(key));
  } else if (name == "none") {
    checkNoCoefficients(node, key);
  } else {
    failModel(distortion, name, "radtan, none");
  }
  return Mei(checked(p, intrinsics));
}

CameraModel readOcam(const YamlNode& node, const char* key) {
  const YamlNode intrinsics = node.at("intrinsics");
  const std::vector<double> i = readNumbers(intrinsics, {6}, "cx cy a00 a01 a10 a11");
  const YamlNode distortion = node.at("distortion_model");
  if (distortion.asString() != "polynomial") {
    failModel(distortion, distortion.asString(), "polynomial");
  }
  Ocam::Parameters p;
  p.cx = i[0];
  p.cy = i[1];
  p.affine << i[2], i[3], i[4], i[5];
  p.world2cam = node.at(key).asDoubles();
  if (node.has("cam2world_coeffs")) p.cam2world = node.at("cam2world_coeffs").asDoubles();
  return Ocam(checked(p, node.at(key)));
}

std::string listed(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string lines(const std::string& indent, const char* model, const std::vector<double>& i,
                  const char* distortion, const std::vector<double>& coefficients) {
  return fmt::format(
      "{0}camera_model: {1}\n{0}intrinsics: {2}\n{0}distortion_model: {3}\n"
      "{0}distortion_coeffs: {4}\n",
      indent, model, listed(i), distortion, listed(coefficients));
}

std::vector<double> coefficientsOf(const RadtanDistortion& d) {
  if (d.k4 != 0.0 || d.k5 != 0.0 || d.k6 != 0.0) {
    return {d.k1, d.k2, d.p1, d.p2, d.k3, d.k4, d.k5, d.k6};
  }
  if (d.k3 != 0.0) return {d.k1, d.k2, d.p1, d.p2, d.k3};
  return {d.k1, d.k2, d.p1, d.p2};
}

std::string writeModel(const PinholeRadtan& model, const std::string& indent) {
  const auto& p = model.parameters();
  return lines(indent, "pinhole", {p.fx, p.fy, p.cx, p.cy}, "radtan", coefficientsOf(p.distortion));
}

std::string writeModel(const PinholeEquidistant& model, const std::string& indent) {
  const auto& p = model.parameters();
  return lines(indent, "pinhole", {p.fx, p.fy, p.cx, p.cy}, "equidistant",
               {p.k1, p.k2, p.k3, p.k4});
}

std::string writeModel(const Mei& model, const std::string& indent) {
  const auto& p = model.parameters();
  return lines(indent, "omni", {p.xi, p.gamma1, p.gamma2, p.u0, p.v0}, "radtan",
               coefficientsOf(p.distortion));
}

std::string writeModel(const Ocam& model, const std::string& indent) {
  const Ocam::Parameters p = model.parameters();
  std::string text = lines(
      indent, "ocam", {p.cx, p.cy, p.affine(0, 0), p.affine(0, 1), p.affine(1, 0), p.affine(1, 1)},
      "polynomial", p.world2cam);
  if (!p.cam2world.empty()) {
    text += fmt::format("{}cam2world_coeffs: {}\n", indent, listed(p.cam2world));
  }
  return text;
}

}  // namespace

Camera readCamera(const YamlNode& node, const char* coefficients_key) {
  const YamlNode resolution = node.at("resolution");
  if (!resolution.isSequence() || resolution.size() != 2) {
    resolution.fail("expected [width, height] in pixels");
  }
  const int width = resolution.at(0).asInt();
  const int height = resolution.at(1).asInt();
  if (width <= 0 || height <= 0) {
    resolution.fail(fmt::format("expected a width and height > 0, found {} x {}", width, height));
  }
  constexpr int kLongestSide = 65'535;  // px: what a JPEG can hold
  if (width > kLongestSide || height > kLongestSide) {
    resolution.fail(fmt::format("expected a width and height of at most {}, found {} x {}",
                                kLongestSide, width, height));
  }
  const YamlNode model = node.at("camera_model");
  const std::string name = model.asString();
  if (name == "pinhole") return {readPinhole(node, coefficients_key), width, height};
  if (name == "omni") return {readOmni(node, coefficients_key), width, height};
  if (name == "ocam") return {readOcam(node, coefficients_key), width, height};
  failModel(model, name, "pinhole, omni, ocam");
}

std::string writeCamera(const Camera& camera, const std::string& indent) {
  return std::visit([&](const auto& model) { return writeModel(model, indent); }, camera.model()) +
         fmt::format("{}resolution: [{}, {}]\n", indent, camera.width(), camera.height());
}

SE3 readTransform(const YamlNode& node) {
  constexpr double kTolerance = 1e-5;
  const Eigen::Matrix4d m = node.asMatrix4();
  const Eigen::Matrix3d r = m.topLeftCorner<3, 3>();
  const double deviation = (r * r.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(deviation < kTolerance && r.determinant() > 0.0)) {
    node.fail(
        fmt::format("the upper left 3x3 block is not a rotation: |R R' - I| = {:.3g} (at most "
                    "{}), det R = {:.6g}, R = [{:.6g}, {:.6g}, {:.6g}; {:.6g}, {:.6g}, "
                    "{:.6g}; {:.6g}, {:.6g}, {:.6g}]",
                    deviation, kTolerance, r.determinant(), r(0, 0), r(0, 1), r(0, 2), r(1, 0),
                    r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)));
  }
  if (m.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    node.fail(fmt::format("expected a last row of 0 0 0 1, found {} {} {} {}", m(3, 0), m(3, 1),
                          m(3, 2), m(3, 3)));
  }
  return SE3(m);
}

std::string writeTransform(const char* key, const SE3& transform, const std::string& indent) {
  const Eigen::Matrix4d m = transform.matrix();
  std::string text = fmt::format("{}{}:\n", indent, key);
  for (int i = 0; i < 4; ++i) {
    text += fmt::format("{}  - [{}, {}, {}, {}]\n", indent, m(i, 0), m(i, 1), m(i, 2), m(i, 3));
  }
  return text;
}

void readImuNoise(const YamlNode& node, ImuCalibration& imu) {
  imu.gyroscope_noise_density = readPositive(node.at("gyroscope_noise_density"));
  imu.gyroscope_random_walk = readPositive(node.at("gyroscope_random_walk"));
  imu.accelerometer_noise_density = readPositive(node.at("accelerometer_noise_density"));
  imu.accelerometer_random_walk = readPositive(node.at("accelerometer_random_walk"));
}

double readPositive(const YamlNode& node) {
  const double value = node.asDouble();
  if (!(value > 0.0)) node.fail(fmt::format("expected a number > 0, found {}", value));
  return value;
}

}  // namespace parkade
