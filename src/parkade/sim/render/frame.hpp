// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/sim/render/camera_places.hpp"
#include "parkade/sim/render/moment.hpp"
#include "parkade/sim/render/ray_table.hpp"
#include "parkade/sim/render/shading.hpp"

namespace parkade::sim {

/// A picture in linear light.
struct Radiance {
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector3f> pixels;  ///< red, green, blue in cd/m^2, row by row
};

/// Per pixel: what it shows. Sampled at the pixel's centre.
struct Truth {
  int width = 0;
  int height = 0;
  std::vector<SemanticClass> labels;
  std::vector<std::uint32_t> instances;  ///< 0: structure or nothing
  std::vector<float> depths;             ///< m along the ray; 0: nothing hit
};

/// What a frame is traced with.
struct FrameSetup {
  const StaticTracer* tracer = nullptr;
  const Shader* shader = nullptr;
  const Moment* moment = nullptr;
  bool reflections = true;
  unsigned mask = kMaskAll;  ///< of primary rays
  bool open_above = false;   ///< seen from outside: rays that meet nothing are black
  int threads = 1;
};

/// Traces and shades a frame. The same numbers for any number of threads.
/// edges: of the same camera with 2 x 2 samples per pixel, where the table has one; with it such
/// blocks of 2 x 2 pixels are drawn in which one surface ends before another (frame_edges.hpp).
void traceFrame(const FrameSetup& setup, const RayTable& table, const CameraPlaces& places,
                Radiance& out, const RayTable* edges = nullptr);

/// Labels, instances and depths; the table must have one sample per pixel.
void traceTruth(const FrameSetup& setup, const RayTable& table, const CameraPlaces& places,
                Truth& out);

}  // namespace parkade::sim
