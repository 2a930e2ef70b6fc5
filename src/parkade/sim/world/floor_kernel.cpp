// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/floor_kernel.hpp"

#include <bit>
#include <cstring>

#include "parkade/core/isa_clones.hpp"
#include "parkade/sim/texel.hpp"
#include "parkade/sim/world/floor_maps.hpp"
#include "parkade/sim/world/paint_layer.hpp"

namespace parkade::sim {
namespace {

constexpr int kLanes = kFloorLanes;

// What texel.hpp has, as expressions without branches.
inline std::int32_t roundedDown(float x) {
  const auto truncated = static_cast<std::int32_t>(x);
  return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}
inline std::int32_t mipLevel(float footprint) {
  const float ratio = footprint * (1.0F / 1.4142F);
  const auto above = static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(ratio) - 1U) >> 23;
  return ratio <= 1.0F ? 0 : above - 126;
}
inline std::int32_t atMost(std::int32_t a, std::int32_t b) {
  return a < b ? a : b;
}
inline std::int32_t kept(std::int32_t a, std::int32_t low, std::int32_t high) {
  a = a < low ? low : a;
  return a > high ? high : a;
}
/// 2^-level
inline float shrinkOf(std::int32_t level) {
  return std::bit_cast<float>((127 - level) << 23);
}
/// A signed byte of a texel.
inline float valueOf(std::uint32_t texel, int channel) {
  return static_cast<float>(static_cast<std::int32_t>(texel << (24 - 8 * channel)) >> 24);
}

struct Bilinear {
  alignas(64) float fx[kLanes];
  float fy[kLanes];
  std::int32_t corner[4][kLanes];  // texels: upper two, lower two
};

}  // namespace

PARKADE_ISA_CLONES
void lookAtGround(const GroundTable& table, const float* xs, const float* ys,
                  const float* footprint, FloorLooks& out, float* paint_shade) {
  // 1. The grain, as GreyTexture::sample. The two noises lie turned to each other and to the
  // walls, so that no repeat lines up.
  Bilinear at;
  alignas(64) float fine[kLanes];
  {
    const GreyView& grain = table.fine;
    const std::int32_t last = grain.levels - 1;
    for (int k = 0; k < kLanes; ++k) {
      const std::int32_t level = atMost(mipLevel(footprint[k] / kFineTexel), last);
      const float scale = shrinkOf(level);
      const auto size = static_cast<std::int32_t>(static_cast<float>(grain.size) * scale);
      const float x = (0.819F * xs[k] + 0.574F * ys[k]) / kFineTexel * scale - 0.5F;
      const float y = (-0.574F * xs[k] + 0.819F * ys[k]) / kFineTexel * scale - 0.5F;
      const std::int32_t x0 = roundedDown(x);
      const std::int32_t y0 = roundedDown(y);
      at.fx[k] = x - static_cast<float>(x0);
      at.fy[k] = y - static_cast<float>(y0);
      const std::int32_t left = x0 & (size - 1);
      const std::int32_t right = (x0 + 1) & (size - 1);
      const std::int32_t upper = grain.offsets[level] + (y0 & (size - 1)) * size;
      const std::int32_t lower = grain.offsets[level] + ((y0 + 1) & (size - 1)) * size;
      at.corner[0][k] = upper + left;
      at.corner[1][k] = upper + right;
      at.corner[2][k] = lower + left;
      at.corner[3][k] = lower + right;
    }
    alignas(64) std::int32_t value[4][kLanes];
    for (int c = 0; c < 4; ++c) {
      for (int k = 0; k < kLanes; ++k) value[c][k] = grain.texels[at.corner[c][k]];
    }
    for (int k = 0; k < kLanes; ++k) {
      const float fx = at.fx[k];
      const float a =
          static_cast<float>(value[0][k]) * (1.0F - fx) + static_cast<float>(value[1][k]) * fx;
      const float b =
          static_cast<float>(value[2][k]) * (1.0F - fx) + static_cast<float>(value[3][k]) * fx;
      fine[k] = (a * (1.0F - at.fy[k]) + b * at.fy[k]) / kTexelScale;
    }
  }

  // 2. The maps, as QuadTexture::sample.
  alignas(64) std::uint32_t texel[4][kLanes];
  {
    const QuadView& maps = table.maps;
    const std::int32_t last = maps.levels - 1;
    for (int k = 0; k < kLanes; ++k) {
      const std::int32_t level = atMost(mipLevel(footprint[k] / kFloorMapCell), last);
      const float scale = shrinkOf(level);
      const std::int32_t width = maps.widths[level];
      const std::int32_t height = maps.heights[level];
      const float x = (xs[k] - table.origin_x) / kFloorMapCell * scale - 0.5F;
      const float y = (ys[k] - table.origin_y) / kFloorMapCell * scale - 0.5F;
      const std::int32_t x0 = roundedDown(x);
      const std::int32_t y0 = roundedDown(y);
      at.fx[k] = x - static_cast<float>(x0);
      at.fy[k] = y - static_cast<float>(y0);
      const std::int32_t left = kept(x0, 0, width - 1);
      const std::int32_t right = kept(x0 + 1, 0, width - 1);
      const std::int32_t upper = maps.offsets[level] + kept(y0, 0, height - 1) * width;
      const std::int32_t lower = maps.offsets[level] + kept(y0 + 1, 0, height - 1) * width;
      at.corner[0][k] = upper + left;
      at.corner[1][k] = upper + right;
      at.corner[2][k] = lower + left;
      at.corner[3][k] = lower + right;
    }
    for (int c = 0; c < 4; ++c) {
      for (int k = 0; k < kLanes; ++k) texel[c][k] = maps.texels[at.corner[c][k]];
    }
  }

  // 3. Colour and gloss.
  alignas(64) float part[kLanes];
  alignas(64) float shade[kLanes];
  alignas(64) std::int32_t zone[2][kLanes];
  for (int k = 0; k < kLanes; ++k) {
    const auto map = [&](int channel) {
      const float fx = at.fx[k];
      const float fy = at.fy[k];
      const float a =
          (1.0F - fx) * valueOf(texel[0][k], channel) + fx * valueOf(texel[1][k], channel);
      const float b =
          (1.0F - fx) * valueOf(texel[2][k], channel) + fx * valueOf(texel[3][k], channel);
      return (1.0F / kTexelScale) * ((1.0F - fy) * a + fy * b);
    };
    const float coarse = map(kCloudChannel);
    const float dirt = map(kDirtChannel);
    const float number = table.zones_per_value * map(kZoneChannel);
    const float bare =
        (1.0F + 0.42F * table.grain * fine[k] + (0.10F + 0.22F * table.filth) * coarse) *
        (1.0F - dirt);
    shade[k] = bare > 0.15F ? bare : 0.15F;
    const float paint = (1.0F + 0.12F * table.grain * fine[k] + 0.12F * table.filth * coarse) *
                        (1.0F - 0.7F * dirt);
    paint_shade[k] = paint > 0.2F ? paint : 0.2F;
    out.specular[static_cast<std::size_t>(k)] = table.specular;
    float roughness = table.roughness + 0.10F * coarse + 0.4F * dirt;
    roughness = roughness < 0.02F ? 0.02F : roughness;
    out.roughness[static_cast<std::size_t>(k)] = roughness > 1.0F ? 1.0F : roughness;
    const std::int32_t below = roundedDown(number + 1e-3F);
    const float over = number - static_cast<float>(below);
    part[k] = over < 0.0F ? 0.0F : over > 1.0F ? 1.0F : over;
    zone[0][k] = kept(below, 0, table.zones);
    zone[1][k] = kept(below + 1, 0, table.zones);
  }
  for (int k = 0; k < kLanes; ++k) {
    const float red = table.red[zone[0][k]];
    const float green = table.green[zone[0][k]];
    const float blue = table.blue[zone[0][k]];
    const float over = part[k];
    const auto at_k = static_cast<std::size_t>(k);
    out.red[at_k] = shade[k] * (red + over * (table.red[zone[1][k]] - red));
    out.green[at_k] = shade[k] * (green + over * (table.green[zone[1][k]] - green));
    out.blue[at_k] = shade[k] * (blue + over * (table.blue[zone[1][k]] - blue));
  }
}

PARKADE_ISA_CLONES
void paintLevels(const float* footprint, std::int32_t* level) {
  for (int k = 0; k < kLanes; ++k) {
    level[k] = atMost(mipLevel(footprint[k] / PaintLayer::kCell), PaintLayer::kLevels - 1);
  }
}

PARKADE_ISA_CLONES
void locatePaint(const PaintView& paint, const float* x, const float* y, const std::int32_t* level,
                 PaintPlaces& out) {
  alignas(64) std::int32_t tile[kLanes];
  alignas(64) std::int32_t cell[kLanes];
  alignas(64) std::int32_t stride[kLanes];
  alignas(64) std::int32_t across[kLanes];
  for (int k = 0; k < kLanes; ++k) {
    const std::int32_t bits = PaintLayer::kTileBits - level[k];
    const float scale = 1.0F / (PaintLayer::kCell * static_cast<float>(1 << level[k]));
    const float u = (x[k] - paint.corner_x) * scale - 0.5F;
    const float v = (y[k] - paint.corner_y) * scale - 0.5F;
    // Outside the floor, truncation instead of rounding down finds no tile either.
    const std::int32_t ix = static_cast<std::int32_t>(u) - (u < 0.0F ? 1 : 0);
    const std::int32_t iy = static_cast<std::int32_t>(v) - (v < 0.0F ? 1 : 0);
    out.fx[k] = u - static_cast<float>(ix);
    out.fy[k] = v - static_cast<float>(iy);
    out.ix[k] = ix;
    out.iy[k] = iy;
    const std::int32_t mask = (1 << bits) - 1;
    const std::int32_t in_x = ix & mask;
    const std::int32_t in_y = iy & mask;
    across[k] = (in_x == mask ? 1 : 0) | (in_y == mask ? 1 : 0);
    const std::int32_t tile_x = ix >> bits;
    const std::int32_t tile_y = iy >> bits;
    const std::int32_t outside = (tile_x < 0 ? 1 : 0) | (tile_y < 0 ? 1 : 0) |
                                 (tile_x >= paint.tiles_x ? 1 : 0) |
                                 (tile_y >= paint.tiles_y ? 1 : 0);
    // One entry past the last tile is the tile without paint.
    tile[k] = outside != 0 ? paint.tiles_x * paint.tiles_y : tile_y * paint.tiles_x + tile_x;
    cell[k] = PaintLayer::firstCell(level[k]) + (in_y << bits) + in_x;
    stride[k] = 1 << bits;
  }
  for (int k = 0; k < kLanes; ++k) cell[k] += paint.bases[tile[k]];
  for (int k = 0; k < kLanes; ++k) {
    std::memcpy(&out.upper[k], paint.cells + cell[k], sizeof(std::uint32_t));
    std::memcpy(&out.lower[k], paint.cells + cell[k] + stride[k], sizeof(std::uint32_t));
  }
  for (int k = 0; k < kLanes; ++k) {
    const bool bare = ((out.upper[k] | out.lower[k]) & 0x00ff00ffU) == 0U;
    out.state[k] = across[k] != 0 ? PaintPlaces::kSeam
                   : bare         ? PaintPlaces::kBare
                                  : PaintPlaces::kPainted;
  }
}

}  // namespace parkade::sim
