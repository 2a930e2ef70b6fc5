// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/core/random.hpp"
#include "parkade/sim/garage.hpp"
#include "parkade/sim/world/mesh_builder.hpp"
#include "parkade/sim/world/palette.hpp"
#include "parkade/sim/world/polygon.hpp"
#include "parkade/sim/world/style.hpp"

namespace parkade::sim {

// Parts of the building; each adds its triangles in the garage frame and its materials.

/// Floor (displaced by ramps), walls, rooms with doors, ceiling with beams, the entrance's ramp.
void addShell(const Garage& garage, const GarageStyle& style, Random random, Palette& palette,
              MeshBuilder& mesh);

/// Pillars with guard stripes, coloured bands and zone text.
void addPillars(const Garage& garage, const GarageStyle& style, Palette& palette,
                MeshBuilder& mesh);

/// What a zone's text has to fit on, m: a face of the pillar, or the flat plate before a round one.
inline double zonePlateWidth(const Pillar& pillar) {
  constexpr double kPlate = 0.8;
  return pillar.round ? kPlate * pillar.size.x() : pillar.size.x();
}

/// By how much a zone marker, as a sign, is wider and higher than its text, m.
constexpr double kZoneTextMargin = 0.06;

/// Hanging guide signs and speed-limit plates.
void addSigns(const Garage& garage, const GarageStyle& style, Palette& palette, MeshBuilder& mesh);

/// Speed bumps and wheel stops.
void addRubber(const Garage& garage, Palette& palette, MeshBuilder& mesh);

/// Ducts, pipes, cable trays, cameras, extinguishers.
void addServices(const Garage& garage, const GarageStyle& style, Random random, Palette& palette,
                 MeshBuilder& mesh);

/// Lamps: their housings and Scene::luminaires.
void addLamps(const Garage& garage, const GarageStyle& style, Random random, Palette& palette,
              MeshBuilder& mesh);

/// A point of the garage frame as the renderer takes it.
inline Eigen::Vector3f point3(const Eigen::Vector2d& p, double z) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(z)};
}

}  // namespace parkade::sim
