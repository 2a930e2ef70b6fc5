// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "parkade/sim/render/frame_edges.hpp"
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

/// A tile on its way from samples to pixels.
struct TileWork {
  std::vector<SampleGroup> groups;  ///< room for all; their number follows
  int group_count = 0;
  std::vector<Surface> surfaces;  ///< of the groups
  /// The pixels in blocks: sixteen rays that follow each other then run alike.
  struct Pixel {
    int x = 0;
    int y = 0;
    int end = 0;                                    ///< of its groups
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();  ///< of samples that hit nothing
  };
  std::array<Pixel, kTilePixels> pixels;
  int pixel_count = 0;
  std::array<std::vector<MirrorRay>, kMirrorPlaces> floor;
  std::vector<MirrorRay> other;

  void clear(int samples) {
    groups.resize(static_cast<std::size_t>(kTilePixels) * samples);
    surfaces.resize(groups.size());
    group_count = 0;
    pixel_count = 0;
    for (std::vector<MirrorRay>& rays : floor) {
      rays.clear();
    }
    other.clear();
  }
};

class FrameTracer {
 public:
  FrameTracer(const FrameSetup& setup, const RayTable& table, const CameraPlaces& places)
      : setup_(setup),
        table_(table),
        rays_(setup, table, places),
        samples_(table.grid() * table.grid()) {}

  void traceTile(int tile, PixelBlocks blocks, TileSamples& out) const {
    rays_.trace(tile, blocks, out);
  }
  void shadeTile(int tile, PixelBlocks blocks, const TileSamples& in, Radiance& out,
                 ReflectionBuffer* mirror) const;

 private:
  /// Samples on the same surface are shaded as one.
  void addGroups(const SurfaceHit* hits, const Eigen::Vector3f* directions, TileWork::Pixel& pixel,
                 TileWork& work) const;
  /// The pixel without mirror images; adds its mirror ray, if it needs one.
  void finishPixel(const TileWork::Pixel& pixel, int first_group, TileWork& work, Radiance& out,
                   ReflectionBuffer* mirror) const;
  void traceMirrors(int tile, const std::vector<MirrorRay>& floor,
                    const std::vector<MirrorRay>& other, Radiance& out,
                    ReflectionBuffer& mirror) const;

  const FrameSetup& setup_;
  const RayTable& table_;
  const TileTracer rays_;
  const int samples_;
};

void FrameTracer::addGroups(const SurfaceHit* hits, const Eigen::Vector3f* directions,
                            TileWork::Pixel& pixel, TileWork& work) const {
  const Shader& shader = *setup_.shader;
  const Moment& moment = *setup_.moment;
  const Eigen::Vector3f& eye = rays_.eye(pixel.y);
  const float spread = table_.spread(pixel.x, pixel.y);
  unsigned done = 0;
  for (int i = 0; i < samples_; ++i) {
    if ((done >> static_cast<unsigned>(i) & 1U) != 0U || hits[i].t < 0.0F) {
      continue;
    }
    if (hits[i].triangle == kNoTriangle) {
      if (!setup_.open_above) {
        pixel.sum += shader.missed(eye, directions[i]);
      }
      continue;
    }
    SampleGroup& group = work.groups[static_cast<std::size_t>(work.group_count++)];
    group.count = 1;
    group.hits = hits;
    group.directions = directions;
    group.eye = &eye;
    group.spread = spread;
    group.members[0] = static_cast<std::uint8_t>(i);
    for (int j = i + 1; j < samples_; ++j) {
      if (!shader.areOneSurface(hits[i], hits[j], moment)) {
        continue;
      }
      done |= 1U << static_cast<unsigned>(j);
      group.members[group.count++] = static_cast<std::uint8_t>(j);
    }
  }
}

void FrameTracer::finishPixel(const TileWork::Pixel& pixel, int first_group, TileWork& work,
                              Radiance& out, ReflectionBuffer* mirror) const {
  const std::size_t index = static_cast<std::size_t>(pixel.y) * out.width + pixel.x;
  Eigen::Vector3f sum = pixel.sum;
  const Surface* main = nullptr;  // whose image shows best
  float best = 0.0F;
  const Eigen::Vector3f* direction = nullptr;
  for (int i = first_group; i < pixel.end; ++i) {
    const SampleGroup& group = work.groups[static_cast<std::size_t>(i)];
    const Surface& surface = work.surfaces[static_cast<std::size_t>(i)];
    sum += static_cast<float>(group.count) * surface.radiance;
    if (mirror == nullptr || (!surface.is_floor && surface.roughness >= kSharp)) {
      continue;
    }
    const float cosine = -group.direction(0).dot(surface.normal);
    const float weight = mirrorReflectance(surface.specular, surface.roughness, cosine) *
                         static_cast<float>(group.count) / static_cast<float>(samples_);
    if (weight > best && (surface.is_floor || weight > kFaintest)) {
      main = &surface;
      best = weight;
      direction = &group.direction(0);
    }
  }
  out.pixels[index] = sum / static_cast<float>(samples_);
  if (main == nullptr) {
    return;
  }
  if (!main->is_floor) {
    MirrorRay& ray = work.other.emplace_back();
    ray.pixel = static_cast<std::uint32_t>(index);
    makeMirrorRay(*main, *direction, best, MirrorDensity::kQuarter, 0, ray);
    return;
  }
  mirror->weights[index] = best;
  const MirrorDensity density =
      samples_ == 1 && best < kFaint ? MirrorDensity::kEighth : MirrorDensity::kQuarter;
  const int place = mirrorPlace(density, pixel.x, pixel.y);
  if (place >= 0) {
    MirrorRay& ray = work.floor[static_cast<std::size_t>(place)].emplace_back();
    ray.pixel = static_cast<std::uint32_t>(mirror->slot(pixel.x, pixel.y));
    makeMirrorRay(*main, *direction, best, density, place, ray);
  }
}

void FrameTracer::shadeTile(int tile, PixelBlocks blocks, const TileSamples& in, Radiance& out,
                            ReflectionBuffer* mirror) const {
  const int left = tile % table_.tilesX() * kTile;
  const int top = tile / table_.tilesX() * kTile;
  thread_local TileWork work;
  work.clear(samples_);
  for (int i = 0; i < kTilePixels; ++i) {
    const int block = i / (kBlock * kBlock);
    const int in_x = block % (kTile / kBlock) * kBlock + i % kBlock;
    const int in_y = block / (kTile / kBlock) * kBlock + i / kBlock % kBlock;
    if (left + in_x >= out.width || top + in_y >= out.height || !isIn(blocks, in_x, in_y)) {
      continue;
    }
    TileWork::Pixel& pixel = work.pixels[static_cast<std::size_t>(work.pixel_count++)];
    pixel.sum.setZero();
    pixel.x = left + in_x;
    pixel.y = top + in_y;
    const int first = (in_y * kTile + in_x) * samples_;
    addGroups(in.hits.data() + first, in.directions.data() + first, pixel, work);
    pixel.end = work.group_count;
  }
  setup_.shader->shade(work.groups.data(), work.group_count, samples_, *setup_.moment,
                       work.surfaces.data());
  int first_group = 0;
  for (int i = 0; i < work.pixel_count; ++i) {
    const TileWork::Pixel& pixel = work.pixels[static_cast<std::size_t>(i)];
    finishPixel(pixel, first_group, work, out, mirror);
    first_group = pixel.end;
  }
  if (mirror != nullptr) {
    // Rays of one place of the pattern run alike: side by side they cost half.
    for (std::size_t place = 1; place < work.floor.size(); ++place) {
      work.floor[0].insert(work.floor[0].end(), work.floor[place].begin(), work.floor[place].end());
    }
    traceMirrors(tile, work.floor[0], work.other, out, *mirror);
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

void traceFrame(const FrameSetup& setup, const RayTable& table, const CameraPlaces& places,
                Radiance& out, const RayTable* edges) {
  out.width = table.width();
  out.height = table.height();
  out.pixels.assign(static_cast<std::size_t>(out.width) * out.height, Eigen::Vector3f::Zero());
  thread_local ReflectionBuffer buffer;  // kept: fresh memory costs a page fault per 4 kB
  ReflectionBuffer& mirror = buffer;
  if (setup.reflections) {
    mirror.reset(out.width, out.height);
  }
  ReflectionBuffer* const reflections = setup.reflections ? &mirror : nullptr;
  const FrameTracer tracer(setup, table, places);
  std::optional<FrameTracer> finer;
  if (edges != nullptr) finer.emplace(setup, *edges, places);
  parallelFor(setup.threads, static_cast<std::size_t>(table.tilesY()), [&](std::size_t row) {
    const FlushDenormals flush;
    thread_local TileSamples samples;
    for (int i = 0; i < table.tilesX(); ++i) {
      const int tile = static_cast<int>(row) * table.tilesX() + i;
      tracer.traceTile(tile, kAllBlocks, samples);
      const PixelBlocks fine =
          finer ? findEdges(samples, *setup.shader, *setup.moment) : PixelBlocks{0};
      tracer.shadeTile(tile, ~fine, samples, out, reflections);
      if (fine == 0) continue;
      finer->traceTile(tile, fine, samples);
      finer->shadeTile(tile, fine, samples, out, reflections);
    }
  });
  if (setup.reflections) {
    addFloorReflections(mirror, setup.threads, out);
  }
}

}  // namespace parkade::sim
