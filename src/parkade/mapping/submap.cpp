// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/submap.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace parkade {
namespace {

constexpr double kParallel = 0.94;  // cos 20 degrees
constexpr double kMergeAcross = 0.06;
constexpr double kMergeAlong = 0.12;
constexpr double kMergePoints = 0.3;

std::int64_t keyOf(int x, int y) {
  return (static_cast<std::int64_t>(x) << 32) ^
         static_cast<std::int64_t>(static_cast<std::uint32_t>(y));
}

std::int64_t keyOf(const Eigen::Vector2d& p, double cell) {
  return keyOf(static_cast<int>(std::floor(p.x() / cell)),
               static_cast<int>(std::floor(p.y() / cell)));
}

}  // namespace

template <class Visit>
void LineMap::around(const Eigen::Vector2d& p, double radius, const Visit& visit) const {
  const int x0 = static_cast<int>(std::floor((p.x() - radius) / kCell));
  const int x1 = static_cast<int>(std::floor((p.x() + radius) / kCell));
  const int y0 = static_cast<int>(std::floor((p.y() - radius) / kCell));
  const int y1 = static_cast<int>(std::floor((p.y() + radius) / kCell));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const auto it = cells_.find(keyOf(x, y));
      if (it == cells_.end()) continue;
      for (const int index : it->second) visit(index);
    }
  }
}

void LineMap::add(const LinePoint& point) {
  const Eigen::Vector2d& p = point.p_level;
  int best = -1;
  double best_distance = kMergeAlong;
  around(p, kMergeAlong, [&](int index) {
    const LineFeature& f = features_[static_cast<std::size_t>(index)];
    if (f.semantic_class != point.semantic_class) return;
    if (std::abs(f.normal.dot(point.normal)) < kParallel) return;
    const Eigen::Vector2d from = p - f.p;
    if (std::abs(f.normal.dot(from)) > kMergeAcross) return;
    const double distance = from.norm();
    if (distance < best_distance) {
      best_distance = distance;
      best = index;
    }
  });
  constexpr double kLeastSigma = 1e-3;
  const double sigma = std::max(point.sigma, kLeastSigma);
  const double weight = 1.0 / (sigma * sigma);
  if (best < 0) {
    features_.push_back({p, point.normal, weight, point.semantic_class, 1});
    const int index = static_cast<int>(features_.size()) - 1;
    cells_[keyOf(p, kCell)].push_back(index);
    return;
  }
  // The feature may drift out of its cell by a fraction of kMergeAlong; nearest() has that margin.
  LineFeature& f = features_[static_cast<std::size_t>(best)];
  const double sign = f.normal.dot(point.normal) < 0.0 ? -1.0 : 1.0;
  const double share = weight / (f.weight + weight);
  f.p += share * (p - f.p);
  f.normal = (f.normal + share * (sign * point.normal - f.normal)).normalized();
  f.weight += weight;
  ++f.count;
}

const LineFeature* LineMap::nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& normal,
                                    SemanticClass semantic_class, double radius) const {
  const LineFeature* best = nullptr;
  double best_distance = radius;
  around(p, radius + kMergeAlong, [&](int index) {
    const LineFeature& f = features_[static_cast<std::size_t>(index)];
    if (f.semantic_class != semantic_class) return;
    const double distance = (p - f.p).norm();
    if (distance >= best_distance || std::abs(f.normal.dot(normal)) < kParallel) return;
    best_distance = distance;
    best = &f;
  });
  return best;
}

bool isPointLandmark(SemanticClass semantic_class) {
  switch (semantic_class) {
    case SemanticClass::kArrow:
    case SemanticClass::kSpeedLimitPaint:
    case SemanticClass::kPillar:
    case SemanticClass::kZoneMarker:
    case SemanticClass::kGuideSign:
    case SemanticClass::kSpeedLimitSign:
      return true;
    default:
      return false;
  }
}

void Submap::addLine(const LinePoint& point) {
  low_ = low_.cwiseMin(point.p_level);
  high_ = high_.cwiseMax(point.p_level);
  lines_.add(point);
}

void Submap::addPoint(const PointFeature& point) {
  low_ = low_.cwiseMin(point.p);
  high_ = high_.cwiseMax(point.p);
  const int index = nearestPointIndex(point.p, point.semantic_class, point.text, kMergePoints);
  if (index < 0) {
    point_cells_[keyOf(point.p, kPointCell)].push_back(static_cast<int>(points_.size()));
    points_.push_back(point);
    return;
  }
  PointFeature* same = &points_[static_cast<std::size_t>(index)];
  const Eigen::Matrix2d gain = same->covariance * (same->covariance + point.covariance).inverse();
  same->p += gain * (point.p - same->p);
  same->covariance = ((Eigen::Matrix2d::Identity() - gain) * same->covariance).eval();
  same->covariance = 0.5 * (same->covariance + same->covariance.transpose()).eval();
  if (same->text.empty()) same->text = point.text;
  ++same->count;
}

int Submap::nearestPointIndex(const Eigen::Vector2d& p, SemanticClass c, const std::string& text,
                              double radius) const {
  int best = -1;
  double best_distance = radius;
  // A point that others were fused with may have left its cell, by less than it took them from.
  const double reach = radius + kMergePoints;
  const auto cellOf = [](double x) { return static_cast<int>(std::floor(x / kPointCell)); };
  for (int y = cellOf(p.y() - reach); y <= cellOf(p.y() + reach); ++y) {
    for (int x = cellOf(p.x() - reach); x <= cellOf(p.x() + reach); ++x) {
      const auto it = point_cells_.find(keyOf(x, y));
      if (it == point_cells_.end()) continue;
      for (const int index : it->second) {
        const PointFeature& f = points_[static_cast<std::size_t>(index)];
        if (f.semantic_class != c) continue;
        if (!text.empty() && !f.text.empty() && text != f.text) continue;
        const double distance = (p - f.p).norm();
        if (distance >= best_distance) continue;
        best_distance = distance;
        best = index;
      }
    }
  }
  return best;
}

const PointFeature* Submap::nearestPoint(const Eigen::Vector2d& p, SemanticClass c,
                                         const std::string& text, double radius) const {
  const int index = nearestPointIndex(p, c, text, radius);
  return index < 0 ? nullptr : &points_[static_cast<std::size_t>(index)];
}

void Submap::add(const SemanticFrame& frame, const SE2& T_submap_vehicle) {
  const Eigen::Matrix2d R = T_submap_vehicle.rotationMatrix();
  for (const LinePoint& seen : frame.line_points) {
    LinePoint point = seen;
    point.p_level = T_submap_vehicle * seen.p_level;
    point.normal = R * seen.normal;
    addLine(point);
  }
  for (const SlotObservation& slot : frame.slots) {
    for (int i = 0; i < 2; ++i) {
      PointFeature point;
      point.p = T_submap_vehicle * slot.corners[static_cast<std::size_t>(i)];
      point.covariance = R * slot.entrance_covariance.block<2, 2>(2 * i, 2 * i) * R.transpose();
      point.semantic_class = SemanticClass::kSlotLine;
      point.count = 1;
      if (point.covariance.determinant() > 0.0) addPoint(point);
    }
  }
  for (const ObjectObservation& object : frame.objects) {
    if (!isPointLandmark(object.semantic_class)) continue;
    PointFeature point;
    point.p = T_submap_vehicle * object.position.head<2>();
    point.covariance = R * object.covariance.topLeftCorner<2, 2>() * R.transpose();
    point.semantic_class = object.semantic_class;
    point.text = object.text;
    point.count = 1;
    if (point.covariance.determinant() > 0.0) addPoint(point);
  }
  ++frames_;
}

}  // namespace parkade
