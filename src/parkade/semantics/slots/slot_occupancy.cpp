// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parkade/geometry/planar.hpp"
#include "parkade/semantics/markings/marking_pieces.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

// What cars leave between floor and body. Floor is seen through there, and the body's lower edge
// appears this share of the camera's height farther away than it is.
constexpr double kClearance = 0.2;  // m

// Cameras' parts of the picture fade into each other over so much of the ground.
constexpr double kFade = 2.5;  // m

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
  double either = 0.0;  // a car by the camera that shows most of the point, none by another
  double blind = 0.0;   // m, mean
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
  const double floor = (e.floor + 0.5 * e.either) / (points + e.either);
  const double share = std::clamp((floor - 0.5) / kSure, -1.0, 1.0);
  const double weight = std::min(1.0, points / kEnough) * std::min(1.0, kBlind / (e.blind + 1e-9));
  return 1.0 / (1.0 + std::exp(-kStrongest * weight * share));
}

// Any car covers this middle part: it is narrower and shorter than cars, wherever they stand.
constexpr int kPointsAcross = 9;
constexpr int kPointsDeep = 15;
constexpr int kMiddlePoints = kPointsAcross * kPointsDeep;

std::array<Vector2d, kMiddlePoints> middleOf(const std::array<Vector2d, 4>& corners) {
  std::array<Vector2d, kMiddlePoints> points;
  std::size_t k = 0;
  for (int j = 0; j < kPointsDeep; ++j) {
    for (int i = 0; i < kPointsAcross; ++i) {
      // Bilinear coordinates: a across from left to right, b from the entrance to the rear.
      const double a = 0.3 + 0.4 * i / (kPointsAcross - 1);
      const double b = 0.25 + 0.5 * j / (kPointsDeep - 1);
      points[k++] = (1.0 - b) * ((1.0 - a) * corners[0] + a * corners[1]) +
                    b * ((1.0 - a) * corners[3] + a * corners[2]);
    }
  }
  return points;
}

class SlotGround {
 public:
  SlotGround(const LabelProbe& probe, const BevViews& views, const std::array<Vector2d, 4>& corners)
      : probe_(probe),
        views_(views),
        corners_(corners),
        front_(corners[1] - corners[0]),
        side_(corners[3] - corners[0]),
        area_(cross(front_, side_)) {}

  [[nodiscard]] bool empty() const { return std::abs(area_) < 1e-3; }
  // A wheel's foot is where it appears; a body's is nearer, and must not be the next slot's car.
  [[nodiscard]] bool holds(const Ray& ray, double vehicle) const {
    const double edge = ray.nearEdge(vehicle);
    return inside(ray.at(edge), 0.1) && inside(ray.below(edge), 0.3);
  }
  // Whether a camera beside the one that shows most of p may have drawn what is seen there, and
  // sees no car of this slot. In the fading of one camera into another a car's smear in the one is
  // a ghost on the floor that the other sees.
  [[nodiscard]] bool deniedByOther(const Vector2d& p) const {
    const BevGeometry& geometry = probe_.labels().geometry;
    const std::size_t own = views_.indexAt(geometry, p);
    for (int k = 0; k < 16; ++k) {
      const double turn = k * 0.25 * std::numbers::pi;
      const Vector2d step = (k < 8 ? 0.4 : 1.0) * kFade * Vector2d(std::cos(turn), std::sin(turn));
      const std::size_t other = views_.indexAt(geometry, p + step);
      if (other == own || other >= views_.views.size()) continue;
      const Ray ray(probe_, views_.views[other], p);
      const Ray::Cover cover = ray.cover();
      if (cover.semantic_class != SemanticClass::kVehicle ||
          !inside(ray.at(ray.nearEdge(cover.range)), 0.1)) {
        return true;
      }
    }
    return false;
  }
  void add(const Vector2d& p, Evidence& evidence) const {
    const Ray ray(probe_, views_.viewAt(probe_.labels().geometry, p), p);
    const Ray::Cover cover = ray.cover();
    evidence.blind += ray.blind();
    if (cover.semantic_class == SemanticClass::kFloor) {
      evidence.floor += 1.0;
    } else if (cover.semantic_class == SemanticClass::kVehicle) {
      if (holds(ray, cover.range)) {
        (deniedByOther(p) ? evidence.either : evidence.car) += 1.0;
      } else if (!hidesGround(probe_.at(p))) {
        evidence.floor += 1.0;
      }
    }
  }

 private:
  [[nodiscard]] bool inside(const Vector2d& p, double before) const {
    const double a = cross(p - corners_[0], side_) / area_;
    const double b = cross(front_, p - corners_[0]) / area_;
    // Wheels may stand on the line; the next slot's car does not.
    return a > -0.02 && a < 1.02 && b > -before && b < 1.0;
  }

  const LabelProbe& probe_;
  const BevViews& views_;
  const std::array<Vector2d, 4>& corners_;
  Vector2d front_;
  Vector2d side_;
  double area_;
};

}  // namespace

double probabilityFree(const LabelProbe& probe, const BevViews& views,
                       const std::array<Vector2d, 4>& corners) {
  const SlotGround slot(probe, views, corners);
  if (slot.empty()) return 0.5;
  Evidence evidence;
  for (const Vector2d& p : middleOf(corners)) slot.add(p, evidence);
  evidence.blind /= kMiddlePoints;
  return probability(evidence);
}

double shareSeenOverEntrance(const BevGeometry& geometry, const BevViews& views,
                             const std::array<Vector2d, 4>& corners) {
  int over = 0;
  for (const Vector2d& p : middleOf(corners)) {
    const Vector2d& foot = views.viewAt(geometry, p).foot;
    // Both corners on either side of the sight line, and the camera before the entrance.
    const bool between =
        cross(p - foot, corners[0] - foot) * cross(p - foot, corners[1] - foot) < 0;
    const Vector2d front = corners[1] - corners[0];
    const bool before = cross(front, foot - corners[0]) * cross(front, p - corners[0]) < 0;
    over += between && before ? 1 : 0;
  }
  return static_cast<double>(over) / kMiddlePoints;
}

}  // namespace parkade
