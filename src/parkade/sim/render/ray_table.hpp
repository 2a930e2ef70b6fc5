// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/camera/camera.hpp"
#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {

/// The rays of a camera's pixels, unprojected once: any camera model then costs the same. Of each
/// pixel one sample is taken or four (samplePlace), in packets of sixteen near each other.
class RayTable {
 public:
  static constexpr int kTile = 16;  ///< pixels a side

  /// Directions in the camera frame; lanes without a ray have bit 0 in valid.
  struct alignas(64) Packet {
    float x[kPacket];
    float y[kPacket];
    float z[kPacket];
    std::uint32_t valid = 0;
  };
  /// A cone around all rays of a tile, in the camera frame.
  struct Cone {
    Eigen::Vector3f axis = Eigen::Vector3f::UnitZ();
    float cosine = -1.0F;  ///< of its half angle
  };

  /// Where sample k of four lies, px from the pixel's middle: on a square turned by 26.6 degrees
  /// (rotated grid), so that edges along rows and columns cross the samples one by one.
  static Eigen::Vector2d samplePlace(int k);

  /// grid: the root of the samples per pixel, 1 or 2. offset_px moves all samples (sub-frames).
  RayTable(const Camera& camera, int grid, const Eigen::Vector2d& offset_px, int threads = 1);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int grid() const { return grid_; }
  [[nodiscard]] int tilesX() const { return tiles_x_; }
  [[nodiscard]] int tilesY() const { return tiles_y_; }
  [[nodiscard]] int packetsPerTile() const { return kTile * kTile * grid_ * grid_ / kPacket; }
  [[nodiscard]] const Packet* packets(int tile) const {
    return packets_.data() + static_cast<std::size_t>(tile) * packetsPerTile();
  }
  [[nodiscard]] const Cone& cone(int tile) const { return cones_[static_cast<std::size_t>(tile)]; }
  /// The sample that a lane of a packet serves: pixel inside the tile (row by row) times the
  /// samples per pixel, plus the sample.
  [[nodiscard]] int slot(int packet, int lane) const {
    return slots_[static_cast<std::size_t>(packet) * kPacket + lane];
  }
  /// Angle between neighbouring samples at a pixel, radians (geometric mean of both axes).
  [[nodiscard]] float spread(int x, int y) const {
    return spread_[static_cast<std::size_t>(y) * width_ + x];
  }
  /// Fetches what spread() will read of a tile.
  void prefetchSpread(int tile) const {
    const int x = tile % tiles_x_ * kTile;
    const int y = tile / tiles_x_ * kTile;
    for (int row = y; row < y + kTile && row < height_; ++row) {
      __builtin_prefetch(&spread_[static_cast<std::size_t>(row) * width_ + x]);
    }
  }
  /// Cosine of the angle between a pixel's ray and the optical axis; 0 without a ray.
  [[nodiscard]] const std::vector<float>& axisCosines() const { return axis_cosine_; }

 private:
  [[nodiscard]] std::vector<std::int32_t> makeSlots() const;
  void fillTile(const Camera& camera, int tile, const Eigen::Vector2d& offset_px);
  void fillRow(const Camera& camera, int y);

  int width_;
  int height_;
  int grid_;
  int tiles_x_;
  int tiles_y_;
  std::vector<std::int32_t> slots_;
  std::vector<Packet> packets_;
  std::vector<Cone> cones_;
  std::vector<float> spread_;
  std::vector<float> axis_cosine_;
};

}  // namespace parkade::sim
