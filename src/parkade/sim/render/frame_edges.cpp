// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/frame_edges.hpp"

#include <cmath>

namespace parkade::sim {
namespace {

constexpr int kTileSide = RayTable::kTile;

class EdgeFinder {
 public:
  EdgeFinder(const TileSamples& samples, const Shader& shader, const Moment& moment)
      : samples_(samples), shader_(shader), moment_(moment) {}

  /// Between two pixels of the tile, by their indices.
  [[nodiscard]] bool isEdge(int i, int j) const {
    const SurfaceHit& a = samples_.hits[static_cast<std::size_t>(i)];
    const SurfaceHit& b = samples_.hits[static_cast<std::size_t>(j)];
    if (a.t < 0.0F || b.t < 0.0F) return false;  // no rays
    if (!shader_.areOneSurface(a, b, moment_)) return true;
    if (a.triangle == b.triangle) return false;
    const Eigen::Vector3f& n = a.geometric_normal;
    constexpr float kBehind = 0.02F;  // of the distance, off the other's plane
    const Eigen::Vector3f apart = b.t * samples_.directions[static_cast<std::size_t>(j)] -
                                  a.t * samples_.directions[static_cast<std::size_t>(i)];
    return std::abs(n.dot(apart)) > kBehind * std::min(a.t, b.t) * n.norm();
  }

 private:
  const TileSamples& samples_;
  const Shader& shader_;
  const Moment& moment_;
};

}  // namespace

PixelBlocks findEdges(const TileSamples& samples, const Shader& shader, const Moment& moment) {
  const EdgeFinder finder(samples, shader, moment);
  PixelBlocks blocks = 0;
  for (int y = 0; y < kTileSide; ++y) {
    for (int x = 0; x < kTileSide; ++x) {
      const int i = y * kTileSide + x;
      if (x + 1 < kTileSide && finder.isEdge(i, i + 1)) blocks |= blockOf(x, y) | blockOf(x + 1, y);
      if (y + 1 < kTileSide && finder.isEdge(i, i + kTileSide))
        blocks |= blockOf(x, y) | blockOf(x, y + 1);
    }
  }
  return blocks;
}

}  // namespace parkade::sim
