// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/painted_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "parkade/core/median.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/objects/crossing_stripes.hpp"
#include "parkade/mapping/objects/paint_raster.hpp"
#include "parkade/mapping/slots/slot_axes.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

MapObject crossingObject(const CrossingStripes& stripes) {
  constexpr double kSigma = 0.1;  // m
  MapObject object;
  object.semantic_class = SemanticClass::kCrossing;
  object.outline = stripes.outline();
  for (const Vector2d& p : object.outline) object.position.head<2>() += 0.25 * p;
  object.position_sigma = kSigma;
  return object;
}

void tellCrossing(const CrossingStripes& stripes, ParkingMap& map) {
  constexpr double kPlain = 0.6;  // contrast
  constexpr double kOverlap = 0.3;
  MapObject crossing = crossingObject(stripes);
  const auto is_it = [&](const MapObject& object) {
    return object.semantic_class == SemanticClass::kCrossing &&
           overlapShare(object.outline, crossing.outline) > kOverlap;
  };
  if (stripes.contrast < kPlain || std::any_of(map.objects.begin(), map.objects.end(), is_it)) {
    return;
  }
  crossing.id = nextObjectId(map);
  map.objects.push_back(std::move(crossing));
}

// Aisles of a garage are as wide as each other: how many stripes cross one. Very many where none
// tells it.
int usualCount(const std::vector<CrossingStripes>& whole) {
  if (whole.empty()) return std::numeric_limits<int>::max();
  std::vector<double> counts;
  for (const CrossingStripes& stripes : whole) counts.push_back(stripes.count());
  return static_cast<int>(std::ceil(median(std::move(counts))));
}

void drawStripes(const CrossingStripes& stripes, LayeredGrid& grid) {
  const SE2 T_crossing_map = stripes.T_map_crossing.inverse();
  drawPaint(
      SemanticClass::kCrossing, stripes.outline(),
      [&](const Vector2d& p) { return stripes.holds(T_crossing_map * p); }, grid);
}

}  // namespace

void completeCrossings(ParkingMap& map) {
  constexpr double kApart = 0.7;  // m, between two stripes
  constexpr std::size_t kFewest = 150;
  const std::optional<double> axis = slot_rows::findAxis(map.slots);
  if (!axis) return;
  const PaintRaster raster(map.grid, SemanticClass::kCrossing);
  std::vector<CrossingStripes> whole;  // both ends are in sight
  std::vector<CrossingStripes> others;
  for (const std::vector<Vector2d>& patch : raster.patches(kApart, kFewest)) {
    const std::optional<CrossingStripes> stripes = fitStripes(patch, raster, map.grid, *axis);
    if (stripes) (stripes->has_ends ? whole : others).push_back(*stripes);
  }
  const int usual = usualCount(whole);
  for (const CrossingStripes& stripes : whole) tellCrossing(stripes, map);
  for (const CrossingStripes& stripes : others) {
    if (stripes.count() >= usual) tellCrossing(stripes, map);
  }
  for (const std::vector<CrossingStripes>* group : {&whole, &others}) {
    for (const CrossingStripes& stripes : *group) drawStripes(stripes, map.grid);
  }
}

}  // namespace parkade
