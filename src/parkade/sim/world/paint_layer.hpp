// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

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
  static constexpr int kTile = 128;
  static constexpr int kLevels = 6;  ///< cells of 1 to 32 cm

  PaintLayer(const Eigen::Vector2d& min, const Eigen::Vector2d& max);

  /// Paints one polygon (garage frame). left gives the share of paint that wear has left at a
  /// place, 0 to 1.
  void paint(const std::vector<Eigen::Vector2d>& polygon, std::uint8_t id,
             const std::function<double(const Eigen::Vector2d&)>& left);

  /// Makes the mip-maps; after the last paint() and before the first sample().
  void finish(std::vector<Eigen::Vector3f> albedo_of_paint);

  /// The mean over count places, each averaged over the footprint.
  [[nodiscard]] PaintSample mean(const float* x, const float* y, int count, float footprint) const;

 private:
  struct Cell {
    std::uint8_t coverage = 0;
    std::uint8_t paint = 0;
  };
  struct Tile {
    std::vector<Cell> levels[kLevels];
  };
  /// Lays a share of paint over a cell.
  static void cover(Cell& cell, float share, std::uint8_t id);
  void add(float x, float y, int level, PaintSample& sum) const;
  [[nodiscard]] const Tile* tileAt(int tile_x, int tile_y) const;

  Eigen::Vector2d origin_;
  Eigen::Vector2f corner_;  ///< the origin
  int tiles_x_ = 0;
  int tiles_y_ = 0;
  std::vector<std::unique_ptr<Tile>> tiles_;
  std::vector<Eigen::Vector3f> albedo_;
};

}  // namespace parkade::sim
