// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/sim/render/direct_light.hpp"
#include "parkade/sim/render/tracer.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

struct BakeOptions {
  double floor_cell = 0.1;      ///< m
  double indirect_cell = 0.25;  ///< m
  int gather_rays = 32;
  int bounces = 3;
  void visit(OptionVisitor& v) {
    v.field("floor_cell", floor_cell, "m", "Cell of the floor's map of direct light.", 0.02, 1.0);
    v.field("indirect_cell", indirect_cell, "m", "Cell of the floor's map of bounced light.", 0.05,
            4.0);
    v.field("gather_rays", gather_rays, "count", "Rays per point that gather bounced light.", 16,
            1024);
    v.field("bounces", bounces, "count", "Diffuse bounces of light.", 0, 16);
  }
};

/// A place's light: illuminance per colour channel in lux, and what share of it one flickering lamp
/// brings.
struct BakedPoint {
  Eigen::Vector3f lux = Eigen::Vector3f::Zero();
  std::uint16_t flicker_lamp = kNoLamp;
  std::uint16_t flicker_share = 0;  ///< of 65535
};

/// A grid over the floor's plane; values sit at cell centres.
struct FloorGrid {
  Eigen::Vector2f min = Eigen::Vector2f::Zero();
  float cell = 0.1F;
  int nx = 0;
  int ny = 0;
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(nx) * ny; }
  [[nodiscard]] Eigen::Vector2f center(std::size_t i) const {
    return min + cell * Eigen::Vector2f(static_cast<float>(i % nx) + 0.5F,
                                        static_cast<float>(i / nx) + 0.5F);
  }
  /// The cell of a place, kept inside the grid.
  [[nodiscard]] std::size_t index(float x, float y) const;
  /// Cells and weights of bilinear interpolation, kept inside the grid.
  void bilinear(float x, float y, std::array<std::uint32_t, 4>& cells,
                std::array<float, 4>& weights) const;
};

/// Light that falls on small faces in the six axis directions, on a grid above the floor.
struct ProbeGrid {
  static constexpr int kLevels = 3;
  static constexpr std::array<float, kLevels> kHeights{0.25F, 0.9F, 1.6F};  ///< m above the floor
  FloorGrid plane;
  std::vector<float> floor_z;  ///< per cell of the plane
  /// [cell * kLevels + level]: +x -x +y -y +z -z, lux
  std::vector<std::array<Eigen::Vector3f, 6>> faces;
  /// The light at a place, as an ambient cube: +x -x +y -y +z -z.
  [[nodiscard]] std::array<Eigen::Vector3f, 6> cubeAt(const Eigen::Vector3f& p) const;
  /// Lux on a face with a normal in that light (Valve's ambient cube: squares of the normal).
  static Eigen::Vector3f evaluate(const std::array<Eigen::Vector3f, 6>& cube,
                                  const Eigen::Vector3f& normal);
};

/// All light of a still scene.
struct BakedLight {
  std::vector<BakedPoint> vertices;  ///< one per vertex of the static mesh
  FloorGrid floor_grid;
  std::vector<BakedPoint> floor;
  std::vector<float> floor_z;  ///< per cell of floor_grid
  ProbeGrid probes;
  double raw_floor_lux = 0.0;   ///< mean over open floor from the luminaires' own flux
  double mean_floor_lux = 0.0;  ///< after scaling to the scene's target
};

/// Bakes lamps, daylight and diffuse bounces; the result is scaled so that floor with nothing
/// within 2 m above it has the scene's target_floor_lux on average. The same bytes for any number
/// of threads. Derivation: docs/math/rendering.md.
BakedLight bakeLight(const Scene& scene, const StaticTracer& tracer, const BakeOptions& options,
                     int threads);

}  // namespace parkade::sim
