// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "parkade/sim/world/structure.hpp"

namespace parkade::sim {
namespace {

/// A point on or before a sign, in its frame.
Eigen::Vector3f onSign(const Sign& sign, double x, double y, double z) {
  return (sign.T_world_sign * Eigen::Vector3d(x, y, z)).cast<float>();
}

void addGuideSign(const Sign& sign, double ceiling, std::uint16_t front, std::uint16_t shell,
                  MeshBuilder& mesh) {
  const double w = 0.5 * sign.width;
  const double h = 0.5 * sign.height;
  mesh.quad(onSign(sign, -w, -h, 0.0), onSign(sign, w, -h, 0.0), onSign(sign, w, h, 0.0),
            onSign(sign, -w, h, 0.0), front);
  const Eigen::Vector3d x_axis = sign.T_world_sign.rotation().matrix().col(0);
  mesh.box(onSign(sign, 0.0, 0.0, -0.05),
           {static_cast<float>(w + 0.02), 0.045F, static_cast<float>(h + 0.02)}, shell,
           static_cast<float>(std::atan2(x_axis.y(), x_axis.x())));
  const double top = ceiling - sign.T_world_sign.translation().z();
  for (const double x : {-0.7 * w, 0.7 * w}) {
    mesh.cone(onSign(sign, x, h, -0.05), onSign(sign, x, top, -0.05), 0.012F, 0.012F, 6, shell,
              false);
  }
}

void addLimitSign(const Sign& sign, std::uint16_t front, std::uint16_t shell, MeshBuilder& mesh) {
  constexpr int kSides = 28;
  const double radius = 0.5 * sign.width;
  const Eigen::Vector3f normal =
      (sign.T_world_sign.rotation() * Eigen::Vector3d::UnitZ()).cast<float>();
  const std::uint32_t center = mesh.vertex(onSign(sign, 0.0, 0.0, 0.0), normal, {0.5F, 0.5F});
  for (int i = 0; i <= kSides; ++i) {
    const double angle = 2.0 * M_PI * i / kSides;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const std::uint32_t v =
        mesh.vertex(onSign(sign, radius * c, radius * s, 0.0), normal,
                    {0.5F + 0.5F * static_cast<float>(c), 0.5F + 0.5F * static_cast<float>(s)});
    if (i > 0) mesh.triangle(center, v - 1, v, front);
  }
  mesh.cone(onSign(sign, 0.0, 0.0, -0.03), onSign(sign, 0.0, 0.0, -0.002),
            static_cast<float>(radius), static_cast<float>(radius), kSides, shell);
}

/// The bump's profile lofted across, in segments of alternating colour.
void addBump(const Garage& garage, const Garage::Bump& bump, std::uint16_t yellow,
             std::uint16_t black, MeshBuilder& mesh) {
  constexpr int kProfile = 14;
  constexpr double kSegment = 0.5;
  const Frame2 at{bump.center, bump.heading};
  const double half = 0.5 * bump.width;
  std::vector<double> stations;
  for (const double edge : {0.0, 0.01, 0.025, 0.04, 0.05}) stations.push_back(-half + edge);
  for (double y = -half + kSegment; y < half - 0.06; y += kSegment) stations.push_back(y);
  for (const double edge : {0.05, 0.04, 0.025, 0.01, 0.0}) stations.push_back(half - edge);
  const auto point = [&](int i, double y) {
    const double x = bump.length * (static_cast<double>(i) / kProfile - 0.5);
    const Eigen::Vector2d p = at * Eigen::Vector2d(x, y);
    return point3(p, garage.surfaceHeight(p) + 0.0015);
  };
  for (std::size_t k = 0; k + 1 < stations.size(); ++k) {
    const double y0 = stations[k];
    const double y1 = stations[k + 1];
    const int segment = static_cast<int>((0.5 * (y0 + y1) + half) / kSegment);
    const std::uint16_t material = segment % 2 == 0 ? yellow : black;
    for (int i = 0; i < kProfile; ++i) {
      mesh.quad(point(i, y0), point(i + 1, y0), point(i + 1, y1), point(i, y1), material);
    }
  }
}

void addWheelStop(const Garage& garage, const Marking& marking, std::uint16_t yellow,
                  std::uint16_t black, MeshBuilder& mesh) {
  constexpr double kHeight = 0.1;
  for (const Polygon& outline : marking.polygons) {
    const Eigen::Vector2d along = outline[1] - outline[0];
    const Eigen::Vector2d middle = 0.5 * (outline[0] + outline[2]);
    const double length = along.norm();
    const double depth = (outline[3] - outline[0]).norm();
    const int pieces = std::max(2, static_cast<int>(std::lround(length / 0.28)));
    const Frame2 at{middle, std::atan2(along.y(), along.x())};
    const double floor = garage.floorHeight(middle);
    for (int i = 0; i < pieces; ++i) {
      const double x0 = length * (static_cast<double>(i) / pieces - 0.5);
      const double x1 = length * (static_cast<double>(i + 1) / pieces - 0.5);
      const std::uint16_t material = i % 2 == 0 ? yellow : black;
      // A trapezium: narrower at the top.
      const auto p = [&](double x, double y, double z) {
        return point3(at * Eigen::Vector2d(x, y), floor + z);
      };
      const double b = 0.5 * depth;
      const double t = 0.28 * depth;
      mesh.quad(p(x0, -b, 0), p(x1, -b, 0), p(x1, -t, kHeight), p(x0, -t, kHeight), material);
      mesh.quad(p(x1, b, 0), p(x0, b, 0), p(x0, t, kHeight), p(x1, t, kHeight), material);
      mesh.quad(p(x0, -t, kHeight), p(x1, -t, kHeight), p(x1, t, kHeight), p(x0, t, kHeight),
                material);
      if (i == 0) {
        mesh.quad(p(x0, b, 0), p(x0, -b, 0), p(x0, -t, kHeight), p(x0, t, kHeight), material);
      }
      if (i == pieces - 1) {
        mesh.quad(p(x1, -b, 0), p(x1, b, 0), p(x1, t, kHeight), p(x1, -t, kHeight), material);
      }
    }
  }
}

}  // namespace

void addSigns(const Garage& garage, const GarageStyle& style, Palette& palette, MeshBuilder& mesh) {
  const std::uint16_t guide_shell =
      palette.add("sign_shell", SemanticClass::kGuideSign, Eigen::Vector3f::Constant(0.06F), 0.5F);
  const std::uint16_t limit_shell = palette.add("plate_back", SemanticClass::kSpeedLimitSign,
                                                Eigen::Vector3f::Constant(0.3F), 0.5F);
  std::map<std::string, std::uint16_t> fronts;
  for (const Sign& sign : garage.signs) {
    if (sign.semantic_class == SemanticClass::kGuideSign) {
      if (fronts.count(sign.text) == 0) {
        const int texture = palette.addTexture(guideTexture(sign.width, sign.height, sign.text));
        // Lit from inside, brightly enough to be read in any light.
        fronts[sign.text] = palette.addGlow("guide " + sign.text, SemanticClass::kGuideSign,
                                            Eigen::Vector3f::Constant(0.8F), texture);
      }
      addGuideSign(sign, garage.ceiling_height, fronts[sign.text], guide_shell, mesh);
    } else if (sign.semantic_class == SemanticClass::kSpeedLimitSign) {
      const std::string key = "limit " + sign.text;
      if (fronts.count(key) == 0) {
        const int texture = palette.addTexture(limitTexture(sign.text, style.text_weight));
        fronts[key] = palette.add(key, SemanticClass::kSpeedLimitSign, Eigen::Vector3f::Ones(),
                                  0.4F, 0.04F, texture);
      }
      addLimitSign(sign, fronts[key], limit_shell, mesh);
    }
  }
}

void addRubber(const Garage& garage, Palette& palette, MeshBuilder& mesh) {
  const Eigen::Vector3f yellow(0.62F, 0.42F, 0.04F);
  const Eigen::Vector3f black = Eigen::Vector3f::Constant(0.03F);
  const std::uint16_t bump_yellow = palette.add("bump_yellow", SemanticClass::kSpeedBump, yellow);
  const std::uint16_t bump_black = palette.add("bump_black", SemanticClass::kSpeedBump, black);
  const std::uint16_t stop_yellow = palette.add("stop_yellow", SemanticClass::kWheelStop, yellow);
  const std::uint16_t stop_black = palette.add("stop_black", SemanticClass::kWheelStop, black);
  for (const Garage::Bump& bump : garage.bumps) {
    addBump(garage, bump, bump_yellow, bump_black, mesh);
  }
  for (const Marking& marking : garage.markings) {
    if (marking.semantic_class != SemanticClass::kWheelStop) continue;
    addWheelStop(garage, marking, stop_yellow, stop_black, mesh);
  }
}

}  // namespace parkade::sim
