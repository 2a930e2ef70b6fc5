// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "parkade/mapping/driven_way.hpp"
#include "parkade/mapping/parking_map.hpp"

// What speaks against a slot beside its own lines. Corners as MapSlot's, one frame for all.

namespace parkade {

/// Whether the vehicle's origin crossed a slot's sides or its rear, a fifth within: who parks
/// crosses the entrance alone.
bool drivenThrough(const std::array<Eigen::Vector2d, 4>& corners,
                   const std::vector<DrivenStep>& way);

/// An arrow, a limit, a stop line, a crossing or a bump: slots hold none.
bool isForDrivers(SemanticClass c);

/// Whether the middle of a marking for who drives lies in the slot, a fifth within.
bool holdsRoadMarking(const std::array<Eigen::Vector2d, 4>& corners,
                      const std::vector<MapObject>& objects);

/// Whether a pillar stands in the way into it: not at a side, nor at its rear. What two slots along
/// the aisle leave between them, with a pillar in its middle, looks like one into the aisle. A
/// pillar seen less than half as often as the slot (observations) is more doubtful than that one.
bool holdsPillar(const std::array<Eigen::Vector2d, 4>& corners,
                 const std::vector<MapObject>& objects, std::int64_t observations);

}  // namespace parkade
