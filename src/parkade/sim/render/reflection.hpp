// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "parkade/sim/render/frame.hpp"

namespace parkade::sim {

/// One mirror ray of a pixel.
struct MirrorRay {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::UnitZ();
  float weight = 0.0F;      ///< reflectance times the share of the pixel; 0: no ray
  std::uint32_t pixel = 0;  ///< row by row; of floors: the place in ReflectionBuffer::incoming
  bool from_floor = false;
  std::uint8_t place = 0;  ///< in the floor's pattern
  // The lobe in which lamps show, if they are in sight: see LampMap::glow.
  Eigen::Vector3f lobe_direction = Eigen::Vector3f::UnitZ();
  float lobe_cosine = 1.0F;
  float lobe_roughness = 1.0F;
};

/// What the floor mirrors, before it is averaged over neighbouring pixels. Only every second pixel
/// of every second row sends rays: the buffer has room for those alone, and a border of zeros.
struct ReflectionBuffer {
  int width = 0;                          ///< of the picture
  int height = 0;                         ///< of the picture
  int stride = 0;                         ///< of incoming
  std::vector<Eigen::Vector4f> incoming;  ///< radiance; w is 1 where a floor pixel sent a ray
  std::vector<float> weights;             ///< reflectance per pixel of the picture
  std::vector<Eigen::Vector4f> across;    ///< scratch: averaged along rows
  void reset(int w, int h);
  /// Where the ray of a pixel, both of whose coordinates are even, belongs in incoming.
  [[nodiscard]] std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(y / 2) * stride + x / 2 + 1;
  }
};

/// Which of the 4 x 4 pixels of the pattern send floor mirror rays.
enum class MirrorDensity : std::uint8_t {
  kQuarter,  ///< 4, every second of every second row
  kEighth,   ///< 2, on a diagonal
};

/// Places of the densest pattern.
inline constexpr int kMirrorPlaces = 4;

/// The place of a pixel in the order of those that send a floor mirror ray, or -1.
inline int mirrorPlace(MirrorDensity density, int x, int y) {
  if (((x | y) & 1) != 0) {
    return -1;
  }
  // Of Bayer's matrix the even places.
  constexpr std::array<int, 4> kPlaces{0, 2, 3, 1};
  const int place = kPlaces[static_cast<std::size_t>((y & 2) | (x >> 1 & 1))];
  return density == MirrorDensity::kQuarter || place < 2 ? place : -1;
}

/// The mirror ray of a surface, all but its pixel. On floors its direction is spread over the
/// glossy lobe by the place in a pattern that repeats every 4 x 4 pixels: the mean over any such
/// block is an integral over the lobe.
void makeMirrorRay(const Surface& surface, const Eigen::Vector3f& direction, float weight,
                   MirrorDensity density, int place, MirrorRay& ray);

/// Traces mirror rays of floors into the buffer. moving is what they may meet of the moving
/// objects, or null. Rays of one place of the pattern run alike and should follow each other.
void traceFloorMirror(const FrameSetup& setup, RTCScene moving, const MirrorRay* rays, int count,
                      ReflectionBuffer& floor);

/// Traces mirror rays of other surfaces and adds what they bring to the picture.
void traceMirror(const FrameSetup& setup, const MirrorRay* rays, int count, Radiance& out);

/// Averages the floor's mirror image over neighbours and adds it to the picture.
void addFloorReflections(ReflectionBuffer& floor, int threads, Radiance& out);

}  // namespace parkade::sim
