// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "parkade/sim/scene.hpp"

namespace parkade::sim {

/// What covers the floor at one or several places, averaged over a footprint.
struct PaintSample {
  float coverage = 0.0F;                             ///< of all paints together
  std::uint8_t paint = 0;                            ///< the one that covers most
  float main_coverage = 0.0F;                        ///< of that one
  Eigen::Vector3f albedo = Eigen::Vector3f::Zero();  ///< sum of coverage times colour
};

/// Coverage by paints in sparse tiles of 128 x 128 cells with their mip-maps. Paint ids count
/// from 1; 0 is bare floor.
class PaintLayer {
 public:
  static constexpr float kCell = 0.01F;  ///< m
  static constexpr int kTileBits = 7;
  static constexpr int kTile = 1 << kTileBits;
  static constexpr int kLevels = 6;  ///< cells of 1 to 32 cm
  /// Where a level begins in the cells of a tile.
  static constexpr int firstCell(int level) {
    return (4 * kTile * kTile - (4 * kTile * kTile >> 2 * level)) / 3;
  }

  PaintLayer(const Eigen::Vector2d& min, const Eigen::Vector2d& max);

  /// Paints one polygon (garage frame). left gives the share of paint that wear has left at a
  /// place, 0 to 1.
  void paint(const std::vector<Eigen::Vector2d>& polygon, std::uint8_t id,
             const std::function<double(const Eigen::Vector2d&)>& left);

  /// Makes the mip-maps; after the last paint() and before the first sample().
  void finish(std::vector<Eigen::Vector3f> albedo_of_paint);

  /// The mean over count places, each averaged over the footprint.
  [[nodiscard]] PaintSample mean(const float* x, const float* y, int count, float footprint) const;
  /// mean() of every group of a block.
  void means(const FloorBlock& block, std::array<PaintSample, FloorBlock::kGroups>& out) const;

 private:
  struct Cell {
    std::uint8_t coverage = 0;
    std::uint8_t paint = 0;
  };
  using Tile = std::vector<Cell>;  ///< while painting: of level 0
  /// Lays a share of paint over a cell.
  static void cover(Cell& cell, float share, std::uint8_t id);
  void addCell(std::uint16_t cell, float weight, PaintSample& sum) const;
  /// The cells of several tiles around a point; cell indices count over all tiles of a level.
  void addSeam(int ix, int iy, float fx, float fy, int level, PaintSample& sum) const;
  static void makeCoarser(const std::uint16_t* fine, std::uint16_t* coarse, int size);
  static void takeMean(int count, PaintSample& sum);
  /// First cell of a tile, 0 where there is no paint.
  [[nodiscard]] std::int32_t baseOf(int tile_x, int tile_y) const;

  Eigen::Vector2d origin_;
  Eigen::Vector2f corner_;  ///< the origin
  int tiles_x_ = 0;
  int tiles_y_ = 0;
  std::vector<Tile> painted_;  ///< until finish()
  // Coverage in the low byte, paint in the high one. The first tile has no paint; one base more
  // than there are tiles leads to it, too.
  std::vector<std::uint16_t> cells_;
  std::vector<std::int32_t> bases_;
  std::vector<Eigen::Vector3f> albedo_;
};

}  // namespace parkade::sim
