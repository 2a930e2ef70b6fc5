// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/ray_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/sim/render/parallel.hpp"

namespace parkade::sim {

RayTable::RayTable(const Camera& camera, int grid, const Eigen::Vector2d& offset_px, int threads)
    : width_(camera.width()),
      height_(camera.height()),
      grid_(grid),
      tiles_x_((width_ + kTile - 1) / kTile),
      tiles_y_((height_ + kTile - 1) / kTile) {
  PARKADE_CHECK(grid == 1 || grid == 2, "{} samples a side", grid);
  PARKADE_CHECK(width_ > 0 && height_ > 0, "{} x {} pixels", width_, height_);
  slots_ = makeSlots();
  const int tiles = tiles_x_ * tiles_y_;
  packets_.resize(static_cast<std::size_t>(tiles) * packetsPerTile());
  cones_.resize(static_cast<std::size_t>(tiles));
  parallelFor(threads, static_cast<std::size_t>(tiles),
              [&](std::size_t tile) { fillTile(camera, static_cast<int>(tile), offset_px); });
  spread_.resize(static_cast<std::size_t>(width_) * height_);
  axis_cosine_.resize(spread_.size(), 0.0F);
  parallelFor(threads, static_cast<std::size_t>(height_),
              [&](std::size_t y) { fillRow(camera, static_cast<int>(y)); });
}

Eigen::Vector2d RayTable::samplePlace(int k) {
  constexpr std::array<double, 4> kX = {-0.125, 0.375, -0.375, 0.125};
  constexpr std::array<double, 4> kY = {-0.375, -0.125, 0.125, 0.375};
  const auto at = static_cast<std::size_t>(k);
  return {kX[at], kY[at]};
}

std::vector<std::int32_t> RayTable::makeSlots() const {
  std::vector<std::int32_t> slots;
  for (int packet = 0; packet < packetsPerTile(); ++packet) {
    for (int lane = 0; lane < kPacket; ++lane) {
      if (grid_ == 1) {  // 4 x 4 pixels
        const int x = packet % (kTile / 4) * 4 + lane % 4;
        const int y = packet / (kTile / 4) * 4 + lane / 4;
        slots.push_back(y * kTile + x);
      } else {  // 2 x 2 pixels of 2 x 2 samples
        const int x = packet % (kTile / 2) * 2 + lane / 4 % 2;
        const int y = packet / (kTile / 2) * 2 + lane / 8;
        slots.push_back((y * kTile + x) * 4 + lane % 4);
      }
    }
  }
  return slots;
}

void RayTable::fillTile(const Camera& camera, int tile, const Eigen::Vector2d& offset_px) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> rays;
  for (int p = 0; p < packetsPerTile(); ++p) {
    Packet& packet = packets_[static_cast<std::size_t>(tile) * packetsPerTile() + p];
    for (int lane = 0; lane < kPacket; ++lane) {
      const int sample = slot(p, lane) % (grid_ * grid_);
      const int pixel_of_tile = slot(p, lane) / (grid_ * grid_);
      const int x = tile % tiles_x_ * kTile + pixel_of_tile % kTile;
      const int y = tile / tiles_x_ * kTile + pixel_of_tile / kTile;
      Eigen::Vector2d pixel = Eigen::Vector2d(x, y) + offset_px;
      if (grid_ == 2) pixel += samplePlace(sample);
      Eigen::Vector3d ray;
      packet.x[lane] = packet.y[lane] = 0.0F;
      packet.z[lane] = 1.0F;
      if (x >= width_ || y >= height_ || !camera.unproject(pixel, ray) || !ray.allFinite()) {
        continue;
      }
      ray.normalize();
      packet.valid |= 1U << static_cast<unsigned>(lane);
      packet.x[lane] = static_cast<float>(ray.x());
      packet.y[lane] = static_cast<float>(ray.y());
      packet.z[lane] = static_cast<float>(ray.z());
      rays.push_back(ray.cast<float>());
      sum += rays.back();
    }
  }
  Cone& cone = cones_[static_cast<std::size_t>(tile)];
  if (sum.norm() > 0.0F) {
    cone.axis = sum.normalized();
    cone.cosine = 1.0F;
    for (const Eigen::Vector3f& ray : rays) {
      cone.cosine = std::min(cone.cosine, ray.dot(cone.axis));
    }
  }
}

void RayTable::fillRow(const Camera& camera, int y) {
  const double usual = 1.0 / camera.focalLength();
  for (int x = 0; x < width_; ++x) {
    const std::size_t i = static_cast<std::size_t>(y) * width_ + x;
    Eigen::Vector3d center;
    Eigen::Vector3d right;
    Eigen::Vector3d down;
    double angle = usual;
    if (camera.unproject({x, y}, center)) {
      axis_cosine_[i] = static_cast<float>(center.normalized().z());
      if (camera.unproject({x + 0.5, y}, right) && camera.unproject({x, y + 0.5}, down)) {
        const double a = 2.0 * (right.normalized() - center.normalized()).norm();
        const double b = 2.0 * (down.normalized() - center.normalized()).norm();
        angle = std::sqrt(a * b);
      }
    }
    spread_[i] = static_cast<float>(angle / grid_);
  }
}

}  // namespace parkade::sim
