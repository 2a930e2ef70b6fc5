// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/core/result.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// What became of a later drive's things in a saved map.
struct MergeReport {
  int slots_again = 0;  ///< that the saved map holds, too
  int slots_new = 0;
  int slots_refused = 0;  ///< that lie on one of the saved map's without being it
  int objects_again = 0;
  int objects_new = 0;
  int objects_gone = 0;  ///< paint of the saved map that the later drive saw to be gone
};

/// Adds the map of a later drive to a saved one. Both must be of one world: the later drive was
/// localised in the saved map. What both hold keeps the saved map's id; places are weighed by their
/// sigmas, which errors that all looks share keep from shrinking without end; numbers, zones and
/// texts are those of the more observations; whether a slot is free is what the later drive saw.
/// Painted objects and wheel stops that it does not tell, though it saw bare floor where they were,
/// are dropped. Layers gather the evidence of both, but availability is the later drive's where it
/// looked, and moving things are left out. The pose graph stays that of the drive that made the
/// saved map. Fails, and changes nothing, where the slots of the two do not lie on one another: the
/// maps are of different worlds.
Result<MergeReport> mergeMap(const ParkingMap& later, ParkingMap& saved);

}  // namespace parkade
