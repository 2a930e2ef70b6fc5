// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/mapping/frame_evidence.hpp"

namespace parkade {

/// What one visible pixel says of the five layers of its cell; the rule that the local and the
/// global map share. touch(layer) gives the cell to change, has_dynamic() whether layer 5 knows the
/// cell (it is not made for ground that was never dynamic).
template <class Touch, class HasDynamic>
void updateLayers(const PackedLabels& labels, SemanticClass c, int steps, int dynamic_steps,
                  const Eigen::Vector2d& p_level, const Touch& touch,
                  const HasDynamic& has_dynamic) {
  const LayerRole role = roleOf(c);
  switch (role) {
    case LayerRole::kNone:
      return;
    case LayerRole::kGround:
    case LayerRole::kLine:
    case LayerRole::kRoadMarker: {
      constexpr SemanticClass kFloor = SemanticClass::kFloor;
      addSteps(touch(GridLayer::kParkingLines), role == LayerRole::kLine ? c : kFloor, steps);
      addSteps(touch(GridLayer::kAvailability), kFloor, steps);
      addSteps(touch(GridLayer::kRoadMarkers), role == LayerRole::kRoadMarker ? c : kFloor, steps);
      addSteps(touch(GridLayer::kZoneMarkers), kFloor, steps);
      if (has_dynamic()) addSteps(touch(GridLayer::kDynamic), kFloor, dynamic_steps);
      return;
    }
    case LayerRole::kStructure:
      addSteps(touch(GridLayer::kZoneMarkers), c, steps);
      return;
    case LayerRole::kVehicle:
      if (labels.isMoving(p_level)) {
        addSteps(touch(GridLayer::kDynamic), c, dynamic_steps);
      } else {
        addSteps(touch(GridLayer::kAvailability), c, steps);
      }
      return;
    case LayerRole::kPerson:
      addSteps(touch(GridLayer::kDynamic), c, dynamic_steps);
      return;
  }
}

}  // namespace parkade
