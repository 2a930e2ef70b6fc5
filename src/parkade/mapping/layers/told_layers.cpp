// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/told_layers.hpp"

#include "parkade/mapping/layers/column_feet.hpp"
#include "parkade/mapping/layers/slot_availability.hpp"
#include "parkade/mapping/layers/slot_lines.hpp"
#include "parkade/mapping/layers/unseen_ground.hpp"
#include "parkade/mapping/layers/wall_points.hpp"
#include "parkade/mapping/layers/wheel_stops.hpp"

namespace parkade {
namespace {

// Labels are less exact than key points: by themselves, and once these have drawn what they show.
void completeWalls(const std::vector<Eigen::Vector3d>& wall_places, const std::vector<SE2>& way,
                   double range, ParkingMap& map) {
  forgetWallsInSlots(map.slots, map.grid);
  const std::vector<WallFace> faces = findWallFaces(wall_places, map.objects, kPointsOnFace);
  drawWalls(faces, map.slots, way, range, map.grid);
  forgetUnseenGround(way, range, map.grid);
  const std::vector<WallFace> labelled =
      findWallFaces(wallFronts(map.grid, way, range), map.objects, kLabelsOnFace);
  drawWalls(labelled, map.slots, way, range, map.grid);
  forgetUnseenGround(way, range, map.grid);
  forgetFloorBeyondWalls(faces, map.grid);
  forgetFloorBeyondWalls(labelled, map.grid);
}

}  // namespace

void completeLayers(const std::vector<Eigen::Vector3d>& wall_places, const std::vector<SE2>& way,
                    double range, ParkingMap& map) {
  forgetStrayPillars(map.objects, map.grid);
  completeWalls(wall_places, way, range, map);
  trimColumnFeet(map.objects, map.grid);
  completeColumnFeet(map.objects, map.grid);
  retreatFromUnseen(map.grid);
  completeSlotLines(map.slots, map.grid);
  layDownAvailability(map.slots, map.grid);
  trimWheelStops(map.slots, way, map.grid);
}

}  // namespace parkade
