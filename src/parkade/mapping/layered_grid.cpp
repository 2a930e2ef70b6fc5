// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layered_grid.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// Rounded division towards minus infinity.
std::int32_t floorDiv(int value, int divisor) {
  return value >= 0 ? value / divisor : -((-value + divisor - 1) / divisor);
}

}  // namespace

double GridCell::probability() const {
  return 1.0 / (1.0 + std::exp(-static_cast<double>(log_odds) * kStep));
}

void addEvidence(GridCell& cell, SemanticClass semantic_class, float delta, float limit) {
  PARKADE_CHECK(semantic_class != SemanticClass::kUnknown, "evidence for the unknown class");
  const float old = static_cast<float>(cell.log_odds) * GridCell::kStep;
  float sum = 0.0F;
  if (!cell.known()) {
    cell.semantic_class = semantic_class;
    sum = delta;
  } else if (cell.semantic_class == semantic_class) {
    sum = old + delta;
  } else if (delta <= 0.0F) {
    return;  // the cell does not claim that class anyway
  } else {
    sum = old - delta;
    if (sum < 0.0F) {
      cell.semantic_class = semantic_class;
      sum = -sum;
    }
  }
  const float clamped = std::clamp(sum, -limit, limit) / GridCell::kStep;
  cell.log_odds = static_cast<std::int8_t>(std::lround(std::clamp(clamped, -127.0F, 127.0F)));
}

LayeredGrid::LayeredGrid(double resolution) : resolution_(resolution) {
  PARKADE_CHECK(resolution > 0.0, "resolution of {} m", resolution);
}

Eigen::Vector2i LayeredGrid::cellOf(const Eigen::Vector2d& p_world) const {
  return {static_cast<int>(std::floor(p_world.x() / resolution_)),
          static_cast<int>(std::floor(p_world.y() / resolution_))};
}

Eigen::Vector2d LayeredGrid::centerOf(const Eigen::Vector2i& cell) const {
  return resolution_ * (cell.cast<double>() + Eigen::Vector2d::Constant(0.5));
}

LayeredGrid::TileIndex LayeredGrid::tileOf(const Eigen::Vector2i& cell) {
  return {floorDiv(cell.x(), kTileCells), floorDiv(cell.y(), kTileCells)};
}

std::size_t LayeredGrid::cellInTile(const Eigen::Vector2i& cell) {
  const TileIndex tile = tileOf(cell);
  const int x = cell.x() - tile.x * kTileCells;
  const int y = cell.y() - tile.y * kTileCells;
  return static_cast<std::size_t>(y * kTileCells + x);
}

GridCell LayeredGrid::at(GridLayer layer, const Eigen::Vector2i& cell) const {
  const Tiles& tiles = layers_[index(layer)];
  const auto it = tiles.find(tileOf(cell));
  return it == tiles.end() ? GridCell{} : it->second.cells[cellInTile(cell)];
}

GridCell& LayeredGrid::touch(GridLayer layer, const Eigen::Vector2i& cell) {
  Tile& tile = layers_[index(layer)][tileOf(cell)];
  tile.dirty = true;
  return tile.cells[cellInTile(cell)];
}

void LayeredGrid::fade(GridLayer layer, float factor) {
  PARKADE_CHECK(factor >= 0.0F && factor <= 1.0F, "fading by a factor of {}", factor);
  Tiles& tiles = layers_[index(layer)];
  for (auto it = tiles.begin(); it != tiles.end();) {
    bool any_known = false;
    for (GridCell& cell : it->second.cells) {
      // Truncation instead of rounding: else small values would never reach zero.
      cell.log_odds = static_cast<std::int8_t>(static_cast<float>(cell.log_odds) * factor);
      if (cell.log_odds == 0) cell.semantic_class = SemanticClass::kUnknown;
      any_known = any_known || cell.known();
    }
    it->second.dirty = true;
    it = any_known ? std::next(it) : tiles.erase(it);
  }
}

void LayeredGrid::setTile(GridLayer layer, const TileIndex& at, const Tile& tile) {
  layers_[index(layer)][at] = tile;
}

void LayeredGrid::markClean() {
  for (Tiles& tiles : layers_) {
    for (auto& [at, tile] : tiles) tile.dirty = false;
  }
}

std::optional<LayeredGrid::Bounds> LayeredGrid::bounds(GridLayer layer) const {
  std::optional<Bounds> bounds;
  for (const auto& [at, tile] : layers_[index(layer)]) {
    for (int y = 0; y < kTileCells; ++y) {
      for (int x = 0; x < kTileCells; ++x) {
        if (!tile.cells[static_cast<std::size_t>(y * kTileCells + x)].known()) continue;
        const Eigen::Vector2i cell(at.x * kTileCells + x, at.y * kTileCells + y);
        if (!bounds) bounds = Bounds{cell, cell};
        bounds->min = bounds->min.cwiseMin(cell);
        bounds->max = bounds->max.cwiseMax(cell);
      }
    }
  }
  return bounds;
}

std::optional<LayeredGrid::Bounds> LayeredGrid::bounds() const {
  std::optional<Bounds> all;
  for (const GridLayer layer : kGridLayers) {
    const std::optional<Bounds> one = bounds(layer);
    if (!one) continue;
    if (!all) {
      all = one;
    } else {
      all->min = all->min.cwiseMin(one->min);
      all->max = all->max.cwiseMax(one->max);
    }
  }
  return all;
}

bool operator==(const LayeredGrid& a, const LayeredGrid& b) {
  if (a.resolution() != b.resolution()) return false;
  for (const GridLayer layer : kGridLayers) {
    const auto same = [](const auto& x, const auto& y) {
      return x.first == y.first && x.second.cells == y.second.cells;
    };
    if (!std::equal(a.tiles(layer).begin(), a.tiles(layer).end(), b.tiles(layer).begin(),
                    b.tiles(layer).end(), same)) {
      return false;
    }
  }
  return true;
}

}  // namespace parkade
