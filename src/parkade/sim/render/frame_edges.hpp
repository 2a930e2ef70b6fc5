// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "parkade/sim/render/tile_tracer.hpp"

namespace parkade::sim {

/// Blocks of 2 x 2 pixels of a tile, one bit each, row by row: as the packets of a table of 2 x 2
/// samples.
using PixelBlocks = std::uint64_t;
inline constexpr PixelBlocks kAllBlocks = ~PixelBlocks{0};

/// The block of a pixel of the tile.
inline PixelBlocks blockOf(int x, int y) {
  constexpr int kBlocks = RayTable::kTile / 2;
  static_assert(kBlocks * kBlocks == 64);
  return PixelBlocks{1} << static_cast<unsigned>(y / 2 * kBlocks + x / 2);
}
inline bool isIn(PixelBlocks blocks, int x, int y) {
  return (blocks & blockOf(x, y)) != 0U;
}

/// The blocks with a pixel whose neighbour in the tile shows another surface: another object or
/// material, one that is turned by more than 10 degrees or lies behind. samples: one per pixel.
/// With one sample an edge stands at a whole pixel, and what follows it from picture to picture is
/// drawn along with the pixels: odometry then turns by 0.1 degrees in 100 m. Neighbours across the
/// tile's border are not looked at.
PixelBlocks findEdges(const TileSamples& samples, const Shader& shader, const Moment& moment);

}  // namespace parkade::sim
