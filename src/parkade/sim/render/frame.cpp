// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/reflection.hpp"
#include "parkade/sim/render/tile_tracer.hpp"

namespace parkade::sim {
namespace {

constexpr int kTile = RayTable::kTile;
constexpr float kSharp = 0.35F;     // rougher than this only floors mirror
constexpr float kFaintest = 0.02F;  // mirror images weaker than this are not traced off the floor
constexpr int kBlock = 4;           // pixels a side
constexpr float kFaint = 0.06F;  // with one sample a pixel, floors that mirror less send fewer rays

/// What a pixel mirrors.
struct MirrorSource {
  Surface surface;
  Eigen::Vector3f direction = Eigen::Vector3f::UnitZ();
  float weight = 0.0F;  ///< reflectance times the share of the pixel
};

class FrameTracer {
 public:
  FrameTracer(const FrameSetup& setup, const RayTable& table, const SE3& T_world_cam)
      : setup_(setup),
        table_(table),
        rays_(setup, table, T_world_cam),
        samples_(table.grid() * table.grid()) {}

  void traceTile(int tile, TileSamples& out) const { rays_.trace(tile, out); }
  void shadeTile(int tile, const TileSamples& in, Radiance& out, ReflectionBuffer* mirror) const;

 private:
  [[nodiscard]] const Eigen::Vector3f& eye() const { return rays_.eye(); }
  /// The pixel without mirror images; main: the surface whose image shows best, weight: how well.
  Eigen::Vector3f shadePixel(const SurfaceHit* hits, const Eigen::Vector3f* directions,
                             float spread, MirrorSource& main) const;
  void traceMirrors(int tile, const std::vector<MirrorRay>& floor,
                    const std::vector<MirrorRay>& other, Radiance& out,
                    ReflectionBuffer& mirror) const;

  const FrameSetup& setup_;
  const RayTable& table_;
  const TileTracer rays_;
  const int samples_;
};

Eigen::Vector3f FrameTracer::shadePixel(const SurfaceHit* hits, const Eigen::Vector3f* directions,
                                        float spread, MirrorSource& main) const {
  const Shader& shader = *setup_.shader;
  const Moment& moment = *setup_.moment;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  unsigned done = 0;
  for (int i = 0; i < samples_; ++i) {
    if ((done >> static_cast<unsigned>(i) & 1U) != 0U || hits[i].t < 0.0F) {
      continue;
    }
    if (hits[i].triangle == kNoTriangle) {
      sum += setup_.open_above ? Eigen::Vector3f(Eigen::Vector3f::Zero())
                               : shader.missed(eye(), directions[i]);
      continue;
    }
    // Samples on the same surface are shaded as one.
    std::array<const SurfaceHit*, kMaxSamples> group{&hits[i]};
    std::array<const Eigen::Vector3f*, kMaxSamples> rays{&directions[i]};
    int count = 1;
    const auto material = shader.materialIndex(hits[i], moment);
    const Eigen::Vector3f& n = hits[i].geometric_normal;
    for (int j = i + 1; j < samples_; ++j) {
      if (hits[j].triangle == kNoTriangle || hits[j].object != hits[i].object) {
        continue;
      }
      if (hits[j].triangle != hits[i].triangle) {
        const Eigen::Vector3f& m = hits[j].geometric_normal;
        const float dot = n.dot(m);
        if (shader.materialIndex(hits[j], moment) != material ||
            dot * dot < 0.97F * n.squaredNorm() * m.squaredNorm()) {
          continue;
        }
      }
      done |= 1U << static_cast<unsigned>(j);
      group[static_cast<std::size_t>(count)] = &hits[j];
      rays[static_cast<std::size_t>(count)] = &directions[j];
      ++count;
    }
    Surface surface;
    shader.shade(group.data(), rays.data(), count, eye(), spread, samples_, moment, surface);
    sum += static_cast<float>(count) * surface.radiance;
    const float cosine = -rays[0]->dot(surface.normal);
    const float weight = mirrorReflectance(surface.specular, surface.roughness, cosine) *
                         static_cast<float>(count) / static_cast<float>(samples_);
    if (weight > main.weight &&
        (surface.is_floor || (weight > kFaintest && surface.roughness < kSharp))) {
      main = {surface, *rays[0], weight};
    }
  }
  return sum / static_cast<float>(samples_);
}

void FrameTracer::shadeTile(int tile, const TileSamples& in, Radiance& out,
                            ReflectionBuffer* mirror) const {
  const int left = tile % table_.tilesX() * kTile;
  const int top = tile / table_.tilesX() * kTile;
  thread_local std::array<std::vector<MirrorRay>, kMirrorPlaces> floor;
  thread_local std::vector<MirrorRay> other;
  for (std::vector<MirrorRay>& rays : floor) {
    rays.clear();
  }
  other.clear();
  // In blocks: sixteen rays that follow each other then run alike.
  for (int i = 0; i < kTilePixels; ++i) {
    const int block = i / (kBlock * kBlock);
    const int in_x = block % (kTile / kBlock) * kBlock + i % kBlock;
    const int in_y = block / (kTile / kBlock) * kBlock + i / kBlock % kBlock;
    const int x = left + in_x;
    const int y = top + in_y;
    if (x >= out.width || y >= out.height) {
      continue;
    }
    const int first = (in_y * kTile + in_x) * samples_;
    const std::size_t pixel = static_cast<std::size_t>(y) * out.width + x;
    MirrorSource main;
    out.pixels[pixel] =
        shadePixel(in.hits.data() + first, in.directions.data() + first, table_.spread(x, y), main);
    if (main.weight <= 0.0F || mirror == nullptr) {
      continue;
    }
    if (!main.surface.is_floor) {
      other.push_back(
          makeMirrorRay(main.surface, main.direction, main.weight, MirrorDensity::kQuarter, 0));
      other.back().pixel = static_cast<std::uint32_t>(pixel);
      continue;
    }
    mirror->weights[pixel] = main.weight;
    const MirrorDensity density =
        samples_ == 1 && main.weight < kFaint ? MirrorDensity::kEighth : MirrorDensity::kQuarter;
    const int place = mirrorPlace(density, x, y);
    if (place >= 0) {
      std::vector<MirrorRay>& rays = floor[static_cast<std::size_t>(place)];
      rays.push_back(makeMirrorRay(main.surface, main.direction, main.weight, density, place));
      rays.back().pixel = static_cast<std::uint32_t>(mirror->slot(x, y));
    }
  }
  if (mirror != nullptr) {
    // Rays of one place of the pattern run alike: side by side they cost half.
    for (std::size_t place = 1; place < floor.size(); ++place) {
      floor[0].insert(floor[0].end(), floor[place].begin(), floor[place].end());
    }
    traceMirrors(tile, floor[0], other, out, *mirror);
  }
}

void FrameTracer::traceMirrors(int tile, const std::vector<MirrorRay>& floor,
                               const std::vector<MirrorRay>& other, Radiance& out,
                               ReflectionBuffer& mirror) const {
  if (!floor.empty()) {
    traceFloorMirror(setup_, rays_.movingIn(tile, true), floor.data(),
                     static_cast<int>(floor.size()), mirror);
  }
  if (!other.empty()) {
    traceMirror(setup_, other.data(), static_cast<int>(other.size()), out);
  }
}

}  // namespace

void traceFrame(const FrameSetup& setup, const RayTable& table, const SE3& T_world_cam,
                Radiance& out) {
  out.width = table.width();
  out.height = table.height();
  out.pixels.assign(static_cast<std::size_t>(out.width) * out.height, Eigen::Vector3f::Zero());
  thread_local ReflectionBuffer buffer;  // kept: fresh memory costs a page fault per 4 kB
  ReflectionBuffer& mirror = buffer;
  if (setup.reflections) {
    mirror.reset(out.width, out.height);
  }
  const FrameTracer tracer(setup, table, T_world_cam);
  parallelFor(setup.threads, static_cast<std::size_t>(table.tilesY()), [&](std::size_t row) {
    const FlushDenormals flush;
    thread_local TileSamples samples;
    for (int i = 0; i < table.tilesX(); ++i) {
      const int tile = static_cast<int>(row) * table.tilesX() + i;
      tracer.traceTile(tile, samples);
      tracer.shadeTile(tile, samples, out, setup.reflections ? &mirror : nullptr);
    }
  });
  if (setup.reflections) {
    addFloorReflections(mirror, setup.threads, out);
  }
}

}  // namespace parkade::sim
