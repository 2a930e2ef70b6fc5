// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/object_pillars.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/geometry/planar.hpp"
#include "parkade/semantics/markings/marking_objects.hpp"
#include "parkade/semantics/standing/object_boxes.hpp"

namespace parkade {
namespace {

// Where a pillar's smear has a ragged side, that looks like the foot of another one behind it.
// Pillars do not stand so close.
void dropPillarEchoes(const BevViews& views, const BevGeometry& geometry,
                      std::vector<ObjectObservation>& pillars) {
  constexpr double kBeside = 1.2;  // m, off the sight line through the nearer one
  constexpr double kBehind = 3.5;  // m
  const auto isEchoOf = [&](const ObjectObservation& a, const Eigen::Vector2d& foot,
                            const ObjectObservation& b) {
    if (a.confidence >= b.confidence) return false;
    const Eigen::Vector2d to_a = a.position.head<2>() - foot;
    const Eigen::Vector2d to_b = b.position.head<2>() - foot;
    return to_b.norm() < to_a.norm() && to_b.dot(to_a) > 0.0 &&
           std::abs(cross(to_b, to_a)) < kBeside * to_b.norm() && (to_a - to_b).norm() < kBehind;
  };
  std::vector<ObjectObservation> kept;
  for (const ObjectObservation& a : pillars) {
    const Eigen::Vector2d foot = views.viewAt(geometry, a.position.head<2>()).foot;
    const bool echo = std::any_of(pillars.begin(), pillars.end(),
                                  [&](const ObjectObservation& b) { return isEchoOf(a, foot, b); });
    if (!echo) kept.push_back(a);
  }
  pillars = std::move(kept);
}

}  // namespace

std::vector<ObjectObservation> findPillars(const ContactFinder& finder, const BevLabels& labels,
                                           const BevViews& views, double attitude_sigma,
                                           const PillarOptions& options) {
  constexpr double kGap = 0.2;  // m
  const double pixel = labels.geometry.metres_per_px;
  std::vector<ObjectObservation> objects;
  for (const ContactEdge& edge : finder.find(labels, SemanticClass::kPillar, kGap,
                                             options.min_confidence, options.min_pixels)) {
    const Eigen::Vector2d foot = views.views[static_cast<std::size_t>(edge.view)].foot;
    GroundBox box = fitFaces(edge.points, foot);
    box.size += Eigen::Vector2d::Constant(pixel);
    const double side = box.size.maxCoeff();
    if (side < options.min_size_m || side > options.max_size_m) continue;
    // What is hidden may be as wide again; where the faces' ends are seen it is the depth alone.
    const GroundBox whole = grownTo(box, Eigen::Vector2d::Constant(side), foot);
    const double guessed = side - box.size.minCoeff();
    ObjectObservation object;
    object.semantic_class = SemanticClass::kPillar;
    object.position << whole.center, 0.0;
    object.covariance = groundCovariance(views, labels.geometry, box.center,
                                         options.sigma_px * pixel, attitude_sigma);
    const Eigen::Vector2d ray = (whole.center - foot).normalized();
    const double sigma_depth = 0.3 * guessed;
    object.covariance.topLeftCorner<2, 2>() += sigma_depth * sigma_depth * ray * ray.transpose();
    if (edge.cut) {
      constexpr double kHidden = 0.15;  // m
      object.covariance.topLeftCorner<2, 2>() += kHidden * kHidden * Eigen::Matrix2d::Identity();
    }
    object.outline = whole.outline();
    object.confidence = edge.confidence * (edge.cut ? 0.6 : 1.0);
    objects.push_back(std::move(object));
  }
  dropPillarEchoes(views, labels.geometry, objects);
  return objects;
}

}  // namespace parkade
