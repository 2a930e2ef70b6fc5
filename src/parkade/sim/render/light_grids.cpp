// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "parkade/sim/render/light_bake.hpp"

namespace parkade::sim {

std::size_t FloorGrid::index(float x, float y) const {
  const int ix = std::clamp(static_cast<int>((x - min.x()) / cell), 0, nx - 1);
  const int iy = std::clamp(static_cast<int>((y - min.y()) / cell), 0, ny - 1);
  return static_cast<std::size_t>(iy) * nx + ix;
}

void FloorGrid::bilinear(float x, float y, std::array<std::uint32_t, 4>& cells,
                         std::array<float, 4>& weights) const {
  const float fx =
      std::clamp((x - min.x()) / cell - 0.5F, 0.0F, static_cast<float>(nx - 1) - 1e-3F);
  const float fy =
      std::clamp((y - min.y()) / cell - 0.5F, 0.0F, static_cast<float>(ny - 1) - 1e-3F);
  const int ix = static_cast<int>(fx);
  const int iy = static_cast<int>(fy);
  const float ax = fx - ix;
  const float ay = fy - iy;
  const auto base = static_cast<std::uint32_t>(iy * nx + ix);
  const auto stride = static_cast<std::uint32_t>(nx);
  cells = {base, base + 1, base + stride, base + stride + 1};
  weights = {(1 - ax) * (1 - ay), ax * (1 - ay), (1 - ax) * ay, ax * ay};
}

std::array<Eigen::Vector3f, 6> ProbeGrid::cubeAt(const Eigen::Vector3f& p) const {
  std::array<std::uint32_t, 4> cells;
  std::array<float, 4> weights;
  plane.bilinear(p.x(), p.y(), cells, weights);
  float ground = 0.0F;
  for (int i = 0; i < 4; ++i) {
    ground += weights[i] * floor_z[cells[i]];
  }
  const float height = std::clamp(p.z() - ground, kHeights.front(), kHeights.back());
  const int level = height < kHeights[1] ? 0 : 1;
  const float a = (height - kHeights[level]) / (kHeights[level + 1] - kHeights[level]);
  std::array<Eigen::Vector3f, 6> cube;
  cube.fill(Eigen::Vector3f::Zero());
  for (int i = 0; i < 4; ++i) {
    const std::size_t at = static_cast<std::size_t>(cells[i]) * kLevels + level;
    for (int f = 0; f < 6; ++f) {
      cube[f] += weights[i] * ((1.0F - a) * faces[at][f] + a * faces[at + 1][f]);
    }
  }
  return cube;
}

Eigen::Vector3f ProbeGrid::evaluate(const std::array<Eigen::Vector3f, 6>& cube,
                                    const Eigen::Vector3f& normal) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    sum += normal[axis] * normal[axis] * cube[2 * axis + (normal[axis] < 0.0F ? 1 : 0)];
  }
  return sum;
}

}  // namespace parkade::sim
