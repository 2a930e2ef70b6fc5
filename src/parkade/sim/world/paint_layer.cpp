// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/paint_layer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/sim/texel.hpp"
#include "parkade/sim/world/coverage.hpp"

namespace parkade::sim {

PaintLayer::PaintLayer(const Eigen::Vector2d& min, const Eigen::Vector2d& max)
    : origin_(min), corner_(min.cast<float>()) {
  const Eigen::Vector2d tiles = (max - min) / (kTile * kCell);
  tiles_x_ = std::max(1, static_cast<int>(std::ceil(tiles.x())));
  tiles_y_ = std::max(1, static_cast<int>(std::ceil(tiles.y())));
  tiles_.resize(static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_));
}

void PaintLayer::cover(Cell& cell, float share, std::uint8_t id) {
  const int added = static_cast<int>(std::lround(255.0F * share));
  if (added == 0) return;
  if (cell.paint == id) {
    // Polygons of one paint meet without overlap: their shares add up.
    cell.coverage = static_cast<std::uint8_t>(std::min(255, cell.coverage + added));
  } else if (added >= cell.coverage / 2) {
    cell.paint = id;
    cell.coverage = static_cast<std::uint8_t>(
        std::max<int>(added, cell.coverage - (cell.coverage * added) / 255));
  }
}

void PaintLayer::paint(const std::vector<Eigen::Vector2d>& polygon, std::uint8_t id,
                       const std::function<double(const Eigen::Vector2d&)>& left) {
  PARKADE_CHECK(id > 0, "paint 0 is the bare floor");
  std::vector<Eigen::Vector2d> in_cells;
  in_cells.reserve(polygon.size());
  for (const Eigen::Vector2d& p : polygon) in_cells.emplace_back((p - origin_) / kCell);
  const Coverage coverage = coverageOf(in_cells);
  const int x_end = std::min(coverage.x0 + coverage.width, tiles_x_ * kTile);
  const int y_end = std::min(coverage.y0 + coverage.height, tiles_y_ * kTile);
  for (int y = std::max(0, coverage.y0); y < y_end; ++y) {
    for (int x = std::max(0, coverage.x0); x < x_end; ++x) {
      float share = coverage.at(x, y);
      if (share <= 0.0F) continue;
      const Eigen::Vector2d center = origin_ + kCell * Eigen::Vector2d(x + 0.5, y + 0.5);
      share *= static_cast<float>(left(center));
      auto& tile = tiles_[static_cast<std::size_t>(y / kTile) * static_cast<std::size_t>(tiles_x_) +
                          static_cast<std::size_t>(x / kTile)];
      if (!tile) {
        tile = std::make_unique<Tile>();
        tile->levels[0].resize(kTile * kTile);
      }
      cover(tile->levels[0][static_cast<std::size_t>((y % kTile) * kTile + x % kTile)], share, id);
    }
  }
}

void PaintLayer::finish(std::vector<Eigen::Vector3f> albedo_of_paint) {
  albedo_ = std::move(albedo_of_paint);
  for (const std::unique_ptr<Tile>& tile : tiles_) {
    if (!tile) continue;
    for (int level = 1; level < kLevels; ++level) {
      const int size = kTile >> level;
      const std::vector<Cell>& fine = tile->levels[level - 1];
      std::vector<Cell>& coarse = tile->levels[level];
      coarse.resize(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          int sum = 0;
          std::array<std::pair<int, std::uint8_t>, 4> votes;
          for (int k = 0; k < 4; ++k) {
            const Cell& cell =
                fine[static_cast<std::size_t>((2 * y + k / 2) * 2 * size + 2 * x + k % 2)];
            sum += cell.coverage;
            votes[static_cast<std::size_t>(k)] = {cell.coverage, cell.paint};
          }
          int best = -1;
          Cell& out = coarse[static_cast<std::size_t>(y * size + x)];
          for (const auto& [unused, paint] : votes) {
            int votes_for = 0;
            for (const auto& [weight, other] : votes) votes_for += other == paint ? weight : 0;
            if (votes_for > best) {
              best = votes_for;
              out.paint = paint;
            }
          }
          out.coverage = static_cast<std::uint8_t>((sum + 2) / 4);
        }
      }
    }
  }
}

const PaintLayer::Tile* PaintLayer::tileAt(int tile_x, int tile_y) const {
  if (tile_x < 0 || tile_y < 0 || tile_x >= tiles_x_ || tile_y >= tiles_y_) return nullptr;
  return tiles_[static_cast<std::size_t>(tile_y) * static_cast<std::size_t>(tiles_x_) +
                static_cast<std::size_t>(tile_x)]
      .get();
}

void PaintLayer::add(float x, float y, int level, PaintSample& sum) const {
  const int bits = 7 - level;  // of a tile's size at this level
  static_assert(kTile == 1 << 7);
  const float scale = 1.0F / (kCell * static_cast<float>(1 << level));
  const float u = (x - corner_.x()) * scale - 0.5F;
  const float v = (y - corner_.y()) * scale - 0.5F;
  // Outside the floor, truncation instead of rounding down finds no tile either.
  const int ix = static_cast<int>(u) - (u < 0.0F ? 1 : 0);
  const int iy = static_cast<int>(v) - (v < 0.0F ? 1 : 0);
  const int mask = (1 << bits) - 1;
  const Tile* tile = tileAt(ix >> bits, iy >> bits);
  const bool inside = (ix & mask) != mask && (iy & mask) != mask;
  if (inside) {
    if (tile == nullptr) return;
    const Cell* row =
        &tile->levels[level][static_cast<std::size_t>(((iy & mask) << bits) + (ix & mask))];
    const Cell* next = row + (std::size_t{1} << bits);
    if ((row[0].coverage | row[1].coverage | next[0].coverage | next[1].coverage) == 0) return;
  }
  const float fx = u - static_cast<float>(ix);
  const float fy = v - static_cast<float>(iy);
  const float weights[4] = {(1.0F - fx) * (1.0F - fy), fx * (1.0F - fy), (1.0F - fx) * fy, fx * fy};
  for (int k = 0; k < 4; ++k) {
    const int cx = ix + k % 2;
    const int cy = iy + k / 2;
    const Tile* here = inside ? tile : tileAt(cx >> bits, cy >> bits);
    if (here == nullptr) continue;
    const Cell& cell =
        here->levels[level][static_cast<std::size_t>(((cy & mask) << bits) + (cx & mask))];
    if (cell.coverage == 0) continue;
    const float share = weights[k] * static_cast<float>(cell.coverage) * (1.0F / 255.0F);
    sum.coverage += share;
    sum.albedo += share * albedo_[cell.paint];
    if (sum.paint == cell.paint) {
      sum.main_coverage += share;
    } else if (share > sum.main_coverage) {
      sum.paint = cell.paint;
      sum.main_coverage = share;
    }
  }
}

PaintSample PaintLayer::mean(const float* x, const float* y, int count, float footprint) const {
  PaintSample result;
  const int level = std::min(mipLevelFor(footprint / kCell), kLevels - 1);
  for (int i = 0; i < count; ++i) {
    add(x[i], y[i], level, result);
  }
  if (count > 1 && result.coverage > 0.0F) {
    const float share = 1.0F / static_cast<float>(count);
    result.coverage *= share;
    result.main_coverage *= share;
    result.albedo *= share;
  }
  return result;
}

}  // namespace parkade::sim
