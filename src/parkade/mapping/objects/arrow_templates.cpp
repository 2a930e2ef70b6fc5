// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/arrow_templates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr float kPaintShare = 0.5F;  // of arrows: paint of the kind, not smear or a neighbour

// Mirrored about its shaft an arrow is one of this meaning.
std::string mirrorOf(const std::string& meaning) {
  if (meaning == "left") return "right";
  if (meaning == "right") return "left";
  if (meaning == "straight_left") return "straight_right";
  if (meaning == "straight_right") return "straight_left";
  return meaning == "straight" ? meaning : std::string();
}

struct ToldArrow {
  SE2 pose;
  Vector2d half_size = Vector2d::Zero();
};

std::map<std::string, std::vector<ToldArrow>> byMeaning(const std::vector<MapObject>& objects) {
  std::map<std::string, std::vector<ToldArrow>> result;
  for (const MapObject& object : objects) {
    if (object.semantic_class != SemanticClass::kArrow || object.text.empty()) continue;
    ToldArrow arrow;
    arrow.pose = SE2(object.heading, object.position.head<2>());
    for (const Vector2d& p : object.outline) {
      arrow.half_size = arrow.half_size.cwiseMax((arrow.pose.inverse() * p).cwiseAbs());
    }
    result[object.text].push_back(arrow);
  }
  return result;
}

// The look of arrows told at these poses, and of mirror images of others.
ArrowTemplate lookOf(const PaintRaster& raster, const std::vector<ToldArrow>& arrows,
                     const std::vector<ToldArrow>& mirrored) {
  constexpr double kMargin = 0.3;  // m
  constexpr double kMost = 5.0;
  Vector2d half = Vector2d::Zero();
  for (const std::vector<ToldArrow>* group : {&arrows, &mirrored}) {
    for (const ToldArrow& arrow : *group) half = half.cwiseMax(arrow.half_size);
  }
  half = (half.array() + kMargin).min(kMost);
  ArrowTemplate look(half.x(), half.y(), raster.resolution());
  for (const ToldArrow& arrow : arrows) look.add(raster, arrow.pose);
  for (const ToldArrow& arrow : mirrored) look.add(raster, arrow.pose, true);
  look.finish();
  return look;
}

}  // namespace

ArrowTemplate::ArrowTemplate(double half_length, double half_width, double step)
    : half_length_(half_length), half_width_(half_width), step_(step) {
  const int rows = 2 * static_cast<int>(std::ceil(half_length / step)) + 1;
  const int columns = 2 * static_cast<int>(std::ceil(half_width / step)) + 1;
  seen_ = cv::Mat1f::zeros(rows, columns);
  shows_ = cv::Mat1f::zeros(rows, columns);
}

Vector2d ArrowTemplate::placeOf(int row, int column) const {
  return step_ * Vector2d(row - seen_.rows / 2, column - seen_.cols / 2);
}

void ArrowTemplate::add(const PaintRaster& raster, const SE2& T_map_arrow, bool mirrored) {
  const double side = mirrored ? -1.0 : 1.0;
  for (int row = 0; row < seen_.rows; ++row) {
    for (int column = 0; column < seen_.cols; ++column) {
      const Vector2d p = placeOf(row, column);
      const auto shares = raster.sharesAt(T_map_arrow * Vector2d(p.x(), side * p.y()));
      seen_(row, column) += static_cast<float>(shares.paint + shares.bare);
      shows_(row, column) += static_cast<float>(shares.paint);
    }
  }
}

void ArrowTemplate::finish() {
  constexpr double kByChance = 0.005;  // share of bare floor that a map holds for an arrow
  constexpr double kWear = 0.6;        // of what told arrows show those not told do
  constexpr double kLeast = 0.1;       // a place that shows less says nothing
  places_.clear();
  for (int row = 0; row < seen_.rows; ++row) {
    for (int column = 0; column < seen_.cols; ++column) {
      const double share = (shows_(row, column) + 0.1) / (seen_(row, column) + 1.0);
      if (seen_(row, column) < 1.0F || share < kLeast) continue;
      const double shown = kWear * share;
      places_.push_back({placeOf(row, column), std::log(shown / kByChance),
                         std::log((1.0 - shown) / (1.0 - kByChance))});
    }
  }
}

bool ArrowTemplate::isPaint(const Vector2d& p) const {
  const int row = static_cast<int>(std::lround(p.x() / step_)) + seen_.rows / 2;
  const int column = static_cast<int>(std::lround(p.y() / step_)) + seen_.cols / 2;
  if (row < 0 || column < 0 || row >= seen_.rows || column >= seen_.cols) return false;
  return shows_(row, column) > kPaintShare * seen_(row, column);
}

std::vector<Vector2d> ArrowTemplate::outline() const {
  Vector2d low = Vector2d::Constant(half_length_ + half_width_);
  Vector2d high = -low;
  for (const Place& place : places_) {
    if (!isPaint(place.p)) continue;
    low = low.cwiseMin(place.p);
    high = high.cwiseMax(place.p);
  }
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

double ArrowTemplate::score(const PaintRaster& raster, const SE2& T_map_arrow) const {
  double sum = 0.0;
  for (const Place& place : places_) {
    const PaintRaster::Shares shares = raster.sharesAt(T_map_arrow * place.p);
    sum += shares.paint * place.paint + shares.bare * place.bare;
  }
  return sum;
}

SE2 ArrowTemplate::align(const PaintRaster& raster, const SE2& T_map_arrow) const {
  const Eigen::Vector3d limit(0.3, 0.3, 3.0 * M_PI / 180.0);
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double most = score(raster, T_map_arrow);
  for (const double scale : {4.0, 2.0, 1.0}) {
    const Eigen::Vector3d steps = scale * Eigen::Vector3d(0.025, 0.025, 0.5 * M_PI / 180.0);
    for (bool better = true; better;) {
      better = false;
      for (int k = 0; k < 6; ++k) {
        Eigen::Vector3d xi = best;
        xi[k / 2] += k % 2 == 0 ? steps[k / 2] : -steps[k / 2];
        if ((xi.cwiseAbs().array() > limit.array() + 1e-9).any()) continue;
        const double s = score(raster, T_map_arrow * SE2(xi.z(), xi.head<2>()));
        if (s <= most) continue;
        most = s;
        best = xi;
        better = true;
      }
    }
  }
  return T_map_arrow * SE2(best.z(), best.head<2>());
}

std::map<std::string, ArrowTemplate> learnArrows(const PaintRaster& raster,
                                                 const std::vector<MapObject>& objects) {
  constexpr int kPasses = 2;
  std::map<std::string, std::vector<ToldArrow>> told = byMeaning(objects);
  std::map<std::string, ArrowTemplate> templates;
  for (int pass = 0; pass <= kPasses; ++pass) {
    templates.clear();
    for (const auto& [meaning, arrows] : told) {
      const auto mirror = told.find(mirrorOf(meaning));
      static const std::vector<ToldArrow> kNone;
      templates.emplace(meaning,
                        lookOf(raster, arrows, mirror == told.end() ? kNone : mirror->second));
    }
    if (pass == kPasses) break;
    for (auto& [meaning, arrows] : told) {
      for (ToldArrow& arrow : arrows) {
        arrow.pose = templates.at(meaning).align(raster, arrow.pose);
      }
    }
  }
  return templates;
}

}  // namespace parkade
