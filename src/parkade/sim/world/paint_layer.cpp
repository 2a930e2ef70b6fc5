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
#include "parkade/sim/world/floor_kernel.hpp"

namespace parkade::sim {

PaintLayer::PaintLayer(const Eigen::Vector2d& min, const Eigen::Vector2d& max)
    : origin_(min), corner_(min.cast<float>()) {
  const Eigen::Vector2d tiles = (max - min) / (kTile * kCell);
  tiles_x_ = std::max(1, static_cast<int>(std::ceil(tiles.x())));
  tiles_y_ = std::max(1, static_cast<int>(std::ceil(tiles.y())));
  painted_.resize(static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_));
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
      Tile& tile =
          painted_[static_cast<std::size_t>(y / kTile) * static_cast<std::size_t>(tiles_x_) +
                   static_cast<std::size_t>(x / kTile)];
      tile.resize(kTile * kTile);
      cover(tile[static_cast<std::size_t>((y % kTile) * kTile + x % kTile)], share, id);
    }
  }
}

void PaintLayer::makeCoarser(const std::uint16_t* fine, std::uint16_t* coarse, int size) {
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      int sum = 0;
      std::array<std::pair<int, int>, 4> votes;
      for (int k = 0; k < 4; ++k) {
        const std::uint16_t cell = fine[(2 * y + k / 2) * 2 * size + 2 * x + k % 2];
        sum += cell & 0xff;
        votes[static_cast<std::size_t>(k)] = {cell & 0xff, cell >> 8};
      }
      int best = -1;
      int winner = 0;
      for (const auto& [unused, paint] : votes) {
        int votes_for = 0;
        for (const auto& [weight, other] : votes) votes_for += other == paint ? weight : 0;
        if (votes_for > best) {
          best = votes_for;
          winner = paint;
        }
      }
      coarse[y * size + x] = static_cast<std::uint16_t>((sum + 2) / 4 | winner << 8);
    }
  }
}

void PaintLayer::finish(std::vector<Eigen::Vector3f> albedo_of_paint) {
  albedo_ = std::move(albedo_of_paint);
  constexpr std::size_t kCells = firstCell(kLevels);
  const auto count = static_cast<std::size_t>(
      std::count_if(painted_.begin(), painted_.end(), [](const Tile& t) { return !t.empty(); }));
  constexpr std::size_t kRoom = kTile + 2;  // what a point at the end of the last tile reads over
  cells_.assign((count + 1) * kCells + kRoom, 0);
  bases_.assign(painted_.size() + 1, 0);
  std::size_t next = kCells;
  for (std::size_t i = 0; i < painted_.size(); ++i) {
    if (painted_[i].empty()) continue;
    bases_[i] = static_cast<std::int32_t>(next);
    std::uint16_t* tile = &cells_[next];
    next += kCells;
    std::transform(painted_[i].begin(), painted_[i].end(), tile, [](const Cell& cell) {
      return static_cast<std::uint16_t>(cell.coverage | cell.paint << 8);
    });
    for (int level = 1; level < kLevels; ++level) {
      makeCoarser(tile + firstCell(level - 1), tile + firstCell(level), kTile >> level);
    }
  }
  std::vector<Tile>().swap(painted_);
}

std::int32_t PaintLayer::baseOf(int tile_x, int tile_y) const {
  if (tile_x < 0 || tile_y < 0 || tile_x >= tiles_x_ || tile_y >= tiles_y_) return 0;
  return bases_[static_cast<std::size_t>(tile_y) * static_cast<std::size_t>(tiles_x_) +
                static_cast<std::size_t>(tile_x)];
}

void PaintLayer::addCell(std::uint16_t cell, float weight, PaintSample& sum) const {
  const int coverage = cell & 0xff;
  if (coverage == 0) return;
  const auto paint = static_cast<std::uint8_t>(cell >> 8);
  const float share = weight * static_cast<float>(coverage) * (1.0F / 255.0F);
  sum.coverage += share;
  sum.albedo += share * albedo_[paint];
  if (sum.paint == paint) {
    sum.main_coverage += share;
  } else if (share > sum.main_coverage) {
    sum.paint = paint;
    sum.main_coverage = share;
  }
}

void PaintLayer::addSeam(int ix, int iy, float fx, float fy, int level, PaintSample& sum) const {
  const int bits = kTileBits - level;
  const int mask = (1 << bits) - 1;
  const float weights[4] = {(1.0F - fx) * (1.0F - fy), fx * (1.0F - fy), (1.0F - fx) * fy, fx * fy};
  for (int k = 0; k < 4; ++k) {
    const int cx = ix + k % 2;
    const int cy = iy + k / 2;
    const std::int32_t cell =
        baseOf(cx >> bits, cy >> bits) + firstCell(level) + ((cy & mask) << bits) + (cx & mask);
    addCell(cells_[static_cast<std::size_t>(cell)], weights[k], sum);
  }
}

void PaintLayer::takeMean(int count, PaintSample& sum) {
  if (count > 1 && sum.coverage > 0.0F) {
    const float share = 1.0F / static_cast<float>(count);
    sum.coverage *= share;
    sum.main_coverage *= share;
    sum.albedo *= share;
  }
}

PaintSample PaintLayer::mean(const float* x, const float* y, int count, float footprint) const {
  PaintSample result;
  const int level = std::min(mipLevelFor(footprint / kCell), kLevels - 1);
  const float scale = 1.0F / (kCell * static_cast<float>(1 << level));
  for (int i = 0; i < count; ++i) {
    const float u = (x[i] - corner_.x()) * scale - 0.5F;
    const float v = (y[i] - corner_.y()) * scale - 0.5F;
    // Outside the floor, truncation instead of rounding down finds no tile either.
    const int ix = static_cast<int>(u) - (u < 0.0F ? 1 : 0);
    const int iy = static_cast<int>(v) - (v < 0.0F ? 1 : 0);
    addSeam(ix, iy, u - static_cast<float>(ix), v - static_cast<float>(iy), level, result);
  }
  takeMean(count, result);
  return result;
}

void PaintLayer::means(const FloorBlock& block,
                       std::array<PaintSample, FloorBlock::kGroups>& out) const {
  constexpr int kLanes = kFloorLanes;
  const PaintView view{cells_.data(), bases_.data(), tiles_x_, tiles_y_, corner_.x(), corner_.y()};
  alignas(64) std::int32_t level_of_group[kLanes];
  paintLevels(block.footprint.data(), level_of_group);
  alignas(64) std::int32_t level[kLanes];
  alignas(64) float x[kLanes];
  alignas(64) float y[kLanes];
  int group_of_lane[kLanes];
  int lanes = 0;
  const auto look = [&] {
    for (int k = lanes; k < kLanes; ++k) {
      x[k] = x[0];
      y[k] = y[0];
      level[k] = level[0];
    }
    PaintPlaces at;
    locatePaint(view, x, y, level, at);
    for (int k = 0; k < lanes; ++k) {
      if (at.state[k] == PaintPlaces::kBare) continue;
      PaintSample& sum = out[static_cast<std::size_t>(group_of_lane[k])];
      const float fx = at.fx[k];
      const float fy = at.fy[k];
      if (at.state[k] == PaintPlaces::kSeam) {
        addSeam(at.ix[k], at.iy[k], fx, fy, level[k], sum);
        continue;
      }
      addCell(static_cast<std::uint16_t>(at.upper[k]), (1.0F - fx) * (1.0F - fy), sum);
      addCell(static_cast<std::uint16_t>(at.upper[k] >> 16U), fx * (1.0F - fy), sum);
      addCell(static_cast<std::uint16_t>(at.lower[k]), (1.0F - fx) * fy, sum);
      addCell(static_cast<std::uint16_t>(at.lower[k] >> 16U), fx * fy, sum);
    }
    lanes = 0;
  };
  for (int i = 0; i < block.count; ++i) {
    const auto group = static_cast<std::size_t>(i);
    out[group] = PaintSample{};
    for (int p = block.first[group]; p < block.first[group + 1]; ++p) {
      x[lanes] = block.x[static_cast<std::size_t>(p)];
      y[lanes] = block.y[static_cast<std::size_t>(p)];
      level[lanes] = level_of_group[i];
      group_of_lane[lanes] = i;
      if (++lanes == kLanes) look();
    }
  }
  if (lanes > 0) look();
  for (int i = 0; i < block.count; ++i) {
    const auto group = static_cast<std::size_t>(i);
    takeMean(block.first[group + 1] - block.first[group], out[group]);
  }
}

}  // namespace parkade::sim
