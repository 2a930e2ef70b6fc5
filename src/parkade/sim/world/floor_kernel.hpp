// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "parkade/sim/scene.hpp"
#include "parkade/sim/world/noise_texture.hpp"
#include "parkade/sim/world/quad_texture.hpp"

namespace parkade::sim {

// The arithmetic of sixteen floor places at once: plain loops over plain arrays that compile for
// several instruction sets and give the same bits in each.

inline constexpr int kFloorLanes = FloorBlock::kGroups;

/// The floor under the paint as plain numbers and tables.
struct GroundTable {
  static constexpr int kMaxZones = 127;
  GreyView fine;  ///< grain
  QuadView maps;  ///< FloorChannel
  float origin_x = 0.0F;
  float origin_y = 0.0F;
  float grain = 0.0F;
  float filth = 0.0F;
  float specular = 0.0F;
  float roughness = 0.0F;
  float zones_per_value = 1.0F;  ///< of kZoneChannel
  int zones = 0;
  // Colours: the floor's own, then of the zones.
  float red[kMaxZones + 1] = {};
  float green[kMaxZones + 1] = {};
  float blue[kMaxZones + 1] = {};
};

/// Bare floor at sixteen places, averaged over a footprint each, and the shade of paint there.
void lookAtGround(const GroundTable& table, const float* x, const float* y, const float* footprint,
                  FloorLooks& out, float* paint_shade);

/// Cells of a PaintLayer as plain arrays: coverage in the low byte, paint in the high one.
struct PaintView {
  const std::uint16_t* cells = nullptr;
  const std::int32_t* bases = nullptr;  ///< first cell of each tile; 0: the tile without paint
  int tiles_x = 0;
  int tiles_y = 0;
  float corner_x = 0.0F;
  float corner_y = 0.0F;
};

/// Where sixteen points lie in a PaintLayer.
struct PaintPlaces {
  enum State : std::int32_t {
    kBare,     ///< no paint at all
    kPainted,  ///< the four cells are in upper and lower
    kSeam,     ///< the four cells lie in several tiles
  };
  alignas(64) float fx[kFloorLanes];  ///< of the way to the next cell
  float fy[kFloorLanes];
  std::int32_t ix[kFloorLanes];  ///< cell, counted over all tiles
  std::int32_t iy[kFloorLanes];
  std::uint32_t upper[kFloorLanes];  ///< cells (ix, iy) and, in the high half, (ix + 1, iy)
  std::uint32_t lower[kFloorLanes];  ///< the row iy + 1
  std::int32_t state[kFloorLanes];
};

/// Looks sixteen points up at a level of the mip-maps each.
void locatePaint(const PaintView& paint, const float* x, const float* y, const std::int32_t* level,
                 PaintPlaces& out);

/// The level of a PaintLayer for sixteen footprints.
void paintLevels(const float* footprint, std::int32_t* level);

}  // namespace parkade::sim
