// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "parkade/geometry/se2.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// A place on the middle of a painted line, fused from the line points that fell on it.
struct LineFeature {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< unit, across the line; sign is arbitrary
  double weight = 0.0;                                ///< sum of 1 / sigma^2
  SemanticClass semantic_class = SemanticClass::kSlotLine;
  int count = 0;
};

/// A point landmark: a slot's entrance corner (class kSlotLine), an arrow, a pillar, a marker.
struct PointFeature {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  SemanticClass semantic_class = SemanticClass::kSlotLine;
  std::string text;
  int count = 0;
};

/// Lines as points with normals, in a hash of square cells.
class LineMap {
 public:
  /// Fuses a line point, given in the map's frame, with the feature that it falls on, or adds one.
  void add(const LinePoint& point);
  /// The nearest feature of that class whose normal is parallel to within 20 degrees; null where
  /// none lies within the radius (at most 1 m).
  [[nodiscard]] const LineFeature* nearest(const Eigen::Vector2d& p, const Eigen::Vector2d& normal,
                                           SemanticClass semantic_class, double radius) const;
  [[nodiscard]] const std::vector<LineFeature>& features() const { return features_; }

 private:
  static constexpr double kCell = 0.25;
  template <class Visit>
  void around(const Eigen::Vector2d& p, double radius, const Visit& visit) const;

  std::vector<LineFeature> features_;
  std::unordered_map<std::int64_t, std::vector<int>> cells_;
};

/// The features that a stretch of the drive showed, in the frame of its anchor: the levelled
/// vehicle where the stretch began. What later frames are registered to.
class Submap {
 public:
  /// Enters a frame seen from T_submap_vehicle.
  void add(const SemanticFrame& frame, const SE2& T_submap_vehicle);
  /// Enters a point of a line, or a point landmark, given in the submap's frame.
  void addLine(const LinePoint& point);
  void addPoint(const PointFeature& point);
  [[nodiscard]] const LineMap& lines() const { return lines_; }
  [[nodiscard]] const std::vector<PointFeature>& points() const { return points_; }
  /// Nearest point of that class within the radius whose text does not contradict; null if none.
  [[nodiscard]] const PointFeature* nearestPoint(const Eigen::Vector2d& p, SemanticClass c,
                                                 const std::string& text, double radius) const;
  [[nodiscard]] int frames() const { return frames_; }
  /// Box around all features.
  [[nodiscard]] const Eigen::Vector2d& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector2d& high() const { return high_; }
  [[nodiscard]] Eigen::Vector2d middle() const { return 0.5 * (low_ + high_); }

 private:
  static constexpr double kPointCell = 1.0;  // m
  [[nodiscard]] int nearestPointIndex(const Eigen::Vector2d& p, SemanticClass c,
                                      const std::string& text, double radius) const;
  LineMap lines_;
  std::vector<PointFeature> points_;
  std::unordered_map<std::int64_t, std::vector<int>> point_cells_;  // where they were entered
  int frames_ = 0;
  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high_ = Eigen::Vector2d::Constant(-1e9);
};

/// Classes of objects whose place is a landmark (not those that are extended or that move).
bool isPointLandmark(SemanticClass semantic_class);

}  // namespace parkade
