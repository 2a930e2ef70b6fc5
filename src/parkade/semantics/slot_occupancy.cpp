// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slot_occupancy.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/semantics/marking_pieces.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

// What cars leave between floor and body. Floor is seen through there, and the body's lower edge
// appears this share of the camera's height farther away than it is.
constexpr double kClearance = 0.2;  // m

// The label at p and those behind it, as one camera sees them.
class Ray {
 public:
  Ray(const LabelProbe& probe, const BevViews::View& view, const Vector2d& p)
      : probe_(probe),
        camera_(view.foot),
        range_((p - view.foot).norm()),
        direction_((p - view.foot) / std::max(range_, 1e-9)),
        step_(2.0 * probe.labels().geometry.metres_per_px),
        hidden_(std::clamp(kClearance / std::max(view.height, 1e-9), 0.0, 0.5)) {}

  // What stands over p, there or behind the floor that is seen below it: a vehicle, something else
  // or nothing (floor), or kUnknown where the picture ends before that can be told.
  struct Cover {
    SemanticClass semantic_class = SemanticClass::kFloor;
    double range = 0.0;  // where it appears
  };
  [[nodiscard]] Cover cover() const {
    const double end = range_ / (1.0 - hidden_) + step_;
    for (double r = range_; r < end; r += step_) {
      const SemanticClass c = probe_.at(at(r));
      if (!hidesGround(c)) continue;
      // Other things stand on the floor: what is seen before them is free.
      const bool tells = c == SemanticClass::kVehicle || c == SemanticClass::kUnknown;
      return {tells || r == range_ ? c : SemanticClass::kFloor, r};
    }
    return {};
  }
  // Where it begins to appear: its last label on the way to the camera.
  [[nodiscard]] double nearEdge(double range) const {
    constexpr double kGap = 0.2;  // m that labels may miss
    double edge = range;
    for (double r = range - step_; r > 0.0 && edge - r < kGap + step_; r -= step_) {
      if (probe_.at(at(r)) == SemanticClass::kVehicle) edge = r;
    }
    return edge;
  }
  // How far behind p the body appears that stands over it.
  [[nodiscard]] double blind() const { return range_ * hidden_ / (1.0 - hidden_); }
  [[nodiscard]] Vector2d at(double range) const { return camera_ + range * direction_; }
  // The same, if it is the body's lower edge and no wheel.
  [[nodiscard]] Vector2d below(double range) const { return at(range * (1.0 - hidden_)); }

 private:
  const LabelProbe& probe_;
  Vector2d camera_;
  double range_;
  Vector2d direction_;
  double step_;
  double hidden_;
};

// What the points of a slot's middle show.
struct Evidence {
  double floor = 0.0;  // points
  double car = 0.0;
  double blind = 0.0;  // m, mean
};

// A free slot shows floor nearly everywhere, a taken one a car over most of its middle: the share
// of either tells, and where they are alike neither does. A few points tell little, and so does
// what lies flat in sight: there floor is seen below a body, and only labels far behind speak of
// it.
double probability(const Evidence& e) {
  constexpr double kStrongest = 4.0;  // log-odds
  constexpr double kEnough = 30.0;    // points
  constexpr double kSure = 0.4;       // beside a half
  constexpr double kBlind = 1.5;      // m
  const double points = e.floor + e.car;
  if (points == 0.0) return 0.5;
  const double share = std::clamp((e.floor / points - 0.5) / kSure, -1.0, 1.0);
  const double weight = std::min(1.0, points / kEnough) * std::min(1.0, kBlind / (e.blind + 1e-9));
  return 1.0 / (1.0 + std::exp(-kStrongest * weight * share));
}

}  // namespace

double probabilityFree(const LabelProbe& probe, const BevViews& views,
                       const std::array<Vector2d, 4>& corners) {
  // Bilinear coordinates: a across from left to right, b from the entrance to the rear.
  const auto at = [&](double a, double b) -> Vector2d {
    return (1.0 - b) * ((1.0 - a) * corners[0] + a * corners[1]) +
           b * ((1.0 - a) * corners[3] + a * corners[2]);
  };
  const Vector2d front = corners[1] - corners[0];
  const Vector2d side = corners[3] - corners[0];
  const double area = std::abs(front.x() * side.y() - front.y() * side.x());
  const auto inside = [&](const Vector2d& p, double before) {
    const Vector2d d = p - corners[0];
    const double a =
        (d.x() * side.y() - d.y() * side.x()) / (front.x() * side.y() - front.y() * side.x());
    const double b =
        (front.x() * d.y() - front.y() * d.x()) / (front.x() * side.y() - front.y() * side.x());
    // Wheels may stand on the line; the next slot's car does not.
    return a > -0.02 && a < 1.02 && b > -before && b < 1.0;
  };
  // A wheel's foot is where it appears; a body's is nearer, and must not be the next slot's car.
  const auto standsHere = [&](const Ray& ray, double vehicle) {
    const double edge = ray.nearEdge(vehicle);
    return inside(ray.at(edge), 0.1) && inside(ray.below(edge), 0.3);
  };
  if (area < 1e-3) return 0.5;
  // Any car covers this middle part: it is narrower and shorter than cars, wherever they stand.
  constexpr int kAcross = 9;
  constexpr int kDeep = 15;
  Evidence evidence;
  for (int j = 0; j < kDeep; ++j) {
    const double b = 0.25 + 0.5 * j / (kDeep - 1);
    for (int i = 0; i < kAcross; ++i) {
      const Vector2d p = at(0.3 + 0.4 * i / (kAcross - 1), b);
      const Ray ray(probe, views.viewAt(probe.labels().geometry, p), p);
      const Ray::Cover cover = ray.cover();
      evidence.blind += ray.blind() / (kAcross * kDeep);
      if (cover.semantic_class == SemanticClass::kFloor) {
        evidence.floor += 1.0;
      } else if (cover.semantic_class == SemanticClass::kVehicle) {
        if (standsHere(ray, cover.range)) {
          evidence.car += 1.0;
        } else if (!hidesGround(probe.at(p))) {
          evidence.floor += 1.0;
        }
      }
    }
  }
  return probability(evidence);
}

}  // namespace parkade
