// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Labels, instances and depths of a camera's pixels.
#include "parkade/core/check.hpp"
#include "parkade/sim/render/frame.hpp"
#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/tile_tracer.hpp"

namespace parkade::sim {
namespace {

constexpr int kTile = RayTable::kTile;

void labelTile(const FrameSetup& setup, const RayTable& table, const TileTracer& tracer, int tile,
               const TileSamples& in, Truth& out) {
  const int left = tile % table.tilesX() * kTile;
  const int top = tile / table.tilesX() * kTile;
  for (int y = 0; y < kTile && top + y < out.height; ++y) {
    const Eigen::Vector3f& eye = tracer.eye(top + y);
    for (int x = 0; x < kTile && left + x < out.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y * kTile + x);
      const SurfaceHit& hit = in.hits[i];
      if (hit.t < 0.0F || hit.triangle == kNoTriangle) {
        continue;
      }
      const std::size_t pixel = static_cast<std::size_t>(top + y) * out.width + left + x;
      out.labels[pixel] = setup.shader->labelOf(hit, eye + hit.t * in.directions[i], *setup.moment);
      out.instances[pixel] =
          hit.object < 0 ? setup.shader->triangleOf(hit, *setup.moment).instance
                         : setup.moment->objects[static_cast<std::size_t>(hit.object)].instance;
      out.depths[pixel] = hit.t;
    }
  }
}

}  // namespace

void traceTruth(const FrameSetup& setup, const RayTable& table, const CameraPlaces& places,
                Truth& out) {
  PARKADE_CHECK(table.grid() == 1, "{} samples a side", table.grid());
  out.width = table.width();
  out.height = table.height();
  const std::size_t size = static_cast<std::size_t>(out.width) * out.height;
  out.labels.assign(size, SemanticClass::kUnknown);
  out.instances.assign(size, 0U);
  out.depths.assign(size, 0.0F);
  const TileTracer tracer(setup, table, places);
  parallelFor(setup.threads, static_cast<std::size_t>(table.tilesY()), [&](std::size_t row) {
    const FlushDenormals flush;
    thread_local TileSamples samples;
    for (int i = 0; i < table.tilesX(); ++i) {
      const int tile = static_cast<int>(row) * table.tilesX() + i;
      tracer.trace(tile, samples);
      labelTile(setup, table, tracer, tile, samples, out);
    }
  });
}

}  // namespace parkade::sim
