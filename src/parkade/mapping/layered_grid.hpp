// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "parkade/types/grid_layer.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {

/// One cell of one layer: the class that it most likely shows, and how sure that is as log-odds in
/// steps of 1/16. A cell never touched has class kUnknown and log-odds 0.
struct GridCell {
  static constexpr float kStep = 1.0F / 16.0F;

  std::int8_t log_odds = 0;
  SemanticClass semantic_class = SemanticClass::kUnknown;

  [[nodiscard]] bool known() const { return semantic_class != SemanticClass::kUnknown; }
  /// The class, unknown where it is doubted.
  [[nodiscard]] SemanticClass believed() const {
    return log_odds > 0 ? semantic_class : SemanticClass::kUnknown;
  }
  /// Probability of the class, 0.5 where nothing is known.
  [[nodiscard]] double probability() const;
  bool operator==(const GridCell&) const = default;
};

/// Evidence for a class (delta > 0) or against it (delta < 0), in log-odds. Evidence for another
/// class than the cell's weakens the cell first and takes it over where its log-odds fall below
/// zero. Both signs saturate at +-limit. docs/math/grid.md, eqs. (1) to (3).
void addEvidence(GridCell& cell, SemanticClass semantic_class, float delta, float limit = 7.0F);

/// Cells of 5 layers over one geometry without bounds: tiles of 64 x 64 cells made where needed.
/// World frame; cell (i, j) covers [i, i + 1) x [j, j + 1) times the resolution along x and y.
class LayeredGrid {
 public:
  static constexpr int kTileCells = 64;

  struct TileIndex {
    std::int32_t x = 0;
    std::int32_t y = 0;
    auto operator<=>(const TileIndex&) const = default;
  };
  struct Tile {
    std::array<GridCell, kTileCells * kTileCells> cells;
    bool dirty = true;  ///< changed since markClean()
  };
  using Tiles = std::map<TileIndex, Tile>;  // ordered: the same bytes whatever the order of growth

  explicit LayeredGrid(double resolution = 0.05);

  [[nodiscard]] double resolution() const { return resolution_; }
  [[nodiscard]] Eigen::Vector2i cellOf(const Eigen::Vector2d& p_world) const;
  [[nodiscard]] Eigen::Vector2d centerOf(const Eigen::Vector2i& cell) const;

  /// A cell as it is; never makes a tile.
  [[nodiscard]] GridCell at(GridLayer layer, const Eigen::Vector2i& cell) const;
  /// A cell to change: makes its tile and marks it dirty.
  GridCell& touch(GridLayer layer, const Eigen::Vector2i& cell);

  /// The cells of a tile, row by row; makes it and marks it dirty. Valid until tiles are dropped.
  std::array<GridCell, kTileCells * kTileCells>& touchTile(GridLayer layer, const TileIndex& at) {
    Tile& tile = layers_[index(layer)][at];
    tile.dirty = true;
    return tile.cells;
  }
  /// The same where the tile exists, which is marked dirty; else null.
  std::array<GridCell, kTileCells * kTileCells>* findTile(GridLayer layer, const TileIndex& at) {
    const auto it = layers_[index(layer)].find(at);
    if (it == layers_[index(layer)].end()) return nullptr;
    it->second.dirty = true;
    return &it->second.cells;
  }

  void add(GridLayer layer, const Eigen::Vector2d& p_world, SemanticClass semantic_class,
           float delta) {
    addEvidence(touch(layer, cellOf(p_world)), semantic_class, delta);
  }

  /// Makes a cell that class, whatever it held; log_odds above 0.
  void set(GridLayer layer, const Eigen::Vector2i& cell, SemanticClass semantic_class,
           float log_odds) {
    GridCell& changed = touch(layer, cell);
    changed = GridCell();
    addEvidence(changed, semantic_class, log_odds);
  }
  /// Makes cells unknown again.
  void forget(GridLayer layer, const std::vector<Eigen::Vector2i>& cells) {
    for (const Eigen::Vector2i& cell : cells) touch(layer, cell) = GridCell();
  }

  /// visit(cell's index, the cell) for every known cell of a layer, tile by tile, row by row.
  template <class Visit>
  void forEachKnown(GridLayer layer, const Visit& visit) const {
    for (const auto& [at, tile] : tiles(layer)) {
      for (int k = 0; k < kTileCells * kTileCells; ++k) {
        const GridCell& cell = tile.cells[static_cast<std::size_t>(k)];
        if (cell.known()) visit(cellOf(at, k), cell);
      }
    }
  }

  /// Moves all log-odds of a layer towards zero by a factor in [0, 1]; cells that reach it are
  /// unknown again, tiles without a known cell are dropped.
  void fade(GridLayer layer, float factor);

  [[nodiscard]] const Tiles& tiles(GridLayer layer) const { return layers_[index(layer)]; }
  /// Replaces a tile, as a reader of files does.
  void setTile(GridLayer layer, const TileIndex& at, const Tile& tile);
  void markClean();

  /// Smallest box of cells that holds every known cell of the layers; nothing where there is none.
  struct Bounds {
    Eigen::Vector2i min = Eigen::Vector2i::Zero();
    Eigen::Vector2i max = Eigen::Vector2i::Zero();  ///< included
  };
  [[nodiscard]] std::optional<Bounds> bounds() const;
  [[nodiscard]] std::optional<Bounds> bounds(GridLayer layer) const;

  [[nodiscard]] static TileIndex tileOf(const Eigen::Vector2i& cell);
  /// The k-th cell of a tile, row by row.
  [[nodiscard]] static Eigen::Vector2i cellOf(const TileIndex& tile, int k) {
    return {tile.x * kTileCells + k % kTileCells, tile.y * kTileCells + k / kTileCells};
  }

 private:
  static std::size_t index(GridLayer layer) { return static_cast<std::size_t>(layer); }
  [[nodiscard]] static std::size_t cellInTile(const Eigen::Vector2i& cell);

  double resolution_;
  std::array<Tiles, kNumGridLayers> layers_;
};

bool operator==(const LayeredGrid& a, const LayeredGrid& b);

/// Whether it holds for a cell or for one of the eight around it.
template <class Holds>
bool anyWithinACell(const Eigen::Vector2i& cell, const Holds& holds) {
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      if (holds(Eigen::Vector2i(cell + Eigen::Vector2i(dx, dy)))) return true;
    }
  }
  return false;
}

}  // namespace parkade
