// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/painted_arrows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/objects/arrow_search.hpp"
#include "parkade/mapping/objects/arrow_templates.hpp"
#include "parkade/mapping/slots/slot_axes.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Looks = std::map<std::string, ArrowTemplate>;
using Outline = std::vector<Vector2d>;

// A convex outline and what lies around it, which is judged with it: its smear and its pieces.
Outline withSurroundings(const Outline& outline) {
  constexpr double kAround = 0.3;  // m
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& p : outline) middle += p / static_cast<double>(outline.size());
  Outline wide;
  for (const Vector2d& p : outline) {
    wide.emplace_back(p + std::sqrt(2.0) * kAround * (p - middle).normalized());
  }
  return wide;
}

// What one arrow explains is none of another's.
void hideArrow(const MapObject& object, PaintRaster& raster) {
  if (object.semantic_class != SemanticClass::kArrow || object.outline.size() < 3) return;
  raster.hide(withSurroundings(object.outline));
}

MapObject arrowObject(const FoundArrow& arrow) {
  constexpr double kSigma = 0.1;  // m
  MapObject object;
  object.semantic_class = SemanticClass::kArrow;
  object.position << arrow.pose.translation(), 0.0;
  object.heading = arrow.pose.angle();
  object.position_sigma = kSigma;
  object.text = arrow.meaning;
  for (const Vector2d& p : arrow.look->outline()) object.outline.push_back(arrow.pose * p);
  return object;
}

// Lines of slots are taken for arrows now and then.
bool liesInSlot(const MapObject& arrow, const std::vector<MapSlot>& slots) {
  constexpr double kOverlap = 0.3;
  return std::any_of(slots.begin(), slots.end(), [&](const MapSlot& slot) {
    const Outline corners(slot.corners.begin(), slot.corners.end());
    return overlapShare(corners, arrow.outline) > kOverlap;
  });
}

void drawArrow(const FoundArrow& arrow, const Outline& outline, LayeredGrid& grid) {
  const SE2 T_arrow_map = arrow.pose.inverse();
  drawPaint(
      SemanticClass::kArrow, outline,
      [&](const Vector2d& p) { return arrow.look->isPaint(T_arrow_map * p); }, grid);
}

// Those told, where the map shows what they are told to be.
void drawTold(const std::vector<MapObject>& objects, const PaintRaster& raster, const Looks& looks,
              LayeredGrid& grid) {
  for (const MapObject& object : objects) {
    const auto look = looks.find(object.text);
    if (object.semantic_class != SemanticClass::kArrow || look == looks.end()) continue;
    const SE2 pose(object.heading, object.position.head<2>());
    const FoundArrow arrow{&look->second, object.text, look->second.align(raster, pose), 0.0};
    const Outline outline = arrowObject(arrow).outline;
    const std::vector<Vector2d> paint = raster.paintIn(withSurroundings(outline));
    if (fitOf(arrow, raster, paint).isGood()) drawArrow(arrow, outline, grid);
  }
}

}  // namespace

void completeArrows(ParkingMap& map) {
  constexpr double kApart = 0.5;  // m, between pieces of one arrow
  constexpr std::size_t kFewest = 25;
  PaintRaster raster(map.grid, SemanticClass::kArrow);
  const Looks looks = learnArrows(raster, map.objects);
  if (looks.empty()) return;
  drawTold(map.objects, raster, looks, map.grid);
  const std::optional<double> axis = slot_rows::findAxis(map.slots);
  if (!axis) return;
  for (const MapObject& object : map.objects) hideArrow(object, raster);
  std::vector<std::vector<Vector2d>> patches = raster.patches(kApart, kFewest);
  std::stable_sort(patches.begin(), patches.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  for (std::vector<Vector2d>& patch : patches) {
    // What is left by those found so far.
    std::erase_if(patch,
                  [&](const Vector2d& p) { return raster.at(p) != PaintRaster::Cell::kPaint; });
    if (patch.size() < kFewest) continue;
    const std::optional<FoundArrow> arrow = findArrow(patch, raster, looks, *axis);
    if (!arrow) continue;
    MapObject object = arrowObject(*arrow);
    if (liesInSlot(object, map.slots)) continue;
    drawArrow(*arrow, object.outline, map.grid);
    hideArrow(object, raster);
    object.id = nextObjectId(map);
    map.objects.push_back(std::move(object));
  }
}

}  // namespace parkade
