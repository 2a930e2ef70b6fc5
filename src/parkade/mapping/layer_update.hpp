// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/mapping/frame_evidence.hpp"

namespace parkade {

/// What one visible pixel says of the five layers of its cell; the rule that the local and the
/// global map share. steps: EvidenceKernel's. new_view: false for a picture from where the one
/// before was taken, whose errors come again: it tells of what comes and goes alone, layers 2
/// and 5. touch(layer) gives the cell to change, has_dynamic() whether layer 5 knows the cell (it
/// is not made for ground that was never dynamic).
template <class Touch, class HasDynamic>
void updateLayers(const PackedLabels& labels, SemanticClass c, const EvidenceSteps& steps,
                  const Eigen::Vector2d& p_level, bool new_view, const Touch& touch,
                  const HasDynamic& has_dynamic) {
  // A picture's border shows too little of a wall to tell it from floor, or where it stands.
  constexpr double kFloorBorder = 0.4;  // m
  constexpr double kWallBorder = 0.6;   // m
  const LayerRole role = roleOf(c);
  switch (role) {
    case LayerRole::kNone:
      return;
    case LayerRole::kGround:
    case LayerRole::kLine:
    case LayerRole::kRoadMarker: {
      constexpr SemanticClass kFloor = SemanticClass::kFloor;
      addSteps(touch(GridLayer::kAvailability), kFloor, steps.seen);
      if (has_dynamic()) addSteps(touch(GridLayer::kDynamic), kFloor, steps.dynamic);
      if (!new_view) return;
      const bool line = role == LayerRole::kLine;
      const bool marker = role == LayerRole::kRoadMarker;
      addSteps(touch(GridLayer::kParkingLines), line ? c : kFloor, line ? steps.seen : steps.bare);
      // Wheel stops do not wear off, and what a picture draws behind one another shows as floor.
      GridCell& marked = touch(GridLayer::kRoadMarkers);
      const bool stop = marked.semantic_class == SemanticClass::kWheelStop;
      addSteps(marked, marker ? c : kFloor, marker || stop ? steps.seen : steps.bare);
      if (labels.toBorder(p_level) > kFloorBorder) {
        addSteps(touch(GridLayer::kZoneMarkers), kFloor, steps.seen);
      }
      return;
    }
    case LayerRole::kStructure:
      if (!new_view) return;
      if (c == SemanticClass::kWall && labels.toBorder(p_level) <= kWallBorder) return;
      addSteps(touch(GridLayer::kZoneMarkers), c, steps.seen);
      return;
    case LayerRole::kVehicle:
      if (labels.isMoving(p_level)) {
        addSteps(touch(GridLayer::kDynamic), c, steps.dynamic);
      } else {
        addSteps(touch(GridLayer::kAvailability), c, steps.seen);
      }
      return;
    case LayerRole::kPerson:
      addSteps(touch(GridLayer::kDynamic), c, steps.dynamic);
      return;
  }
}

}  // namespace parkade
