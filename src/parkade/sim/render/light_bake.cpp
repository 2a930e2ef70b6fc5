// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/light_bake.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/sim/render/baker.hpp"
#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/texture.hpp"

namespace parkade::sim {
namespace {
constexpr float kHeadroom = 2.0F;  // m: floor with less above it is not open
}  // namespace

Baker::Baker(const Scene& scene, const StaticTracer& tracer, const BakeOptions& options,
             int threads)
    : scene_(scene),
      tracer_(tracer),
      options_(options),
      threads_(threads),
      direct_(scene, tracer),
      vertex_count_(tracer.mesh().positions.size()) {
  for (const Material& material : scene.materials) {
    const unsigned mask = maskOf(material);
    kind_of_material_.push_back(mask == kMaskFloor                          ? Kind::kFloor
                                : mask == kMaskLamp                         ? Kind::kLamp
                                : material.label == SemanticClass::kVehicle ? Kind::kVehicle
                                                                            : Kind::kStructure);
    albedo_of_material_.push_back(meanAlbedo(scene, material));
  }
}

std::vector<BakedPoint> Baker::directAt(const std::vector<Place>& places,
                                        std::uint64_t seed) const {
  // Packets hold neighbours: in the order of cells, and never across two cells.
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].used) {
      order.emplace_back(DirectLight::cellOf(places[i].position), i);
    }
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (starts.empty() || i - starts.back() == kPacket ||
        order[i].first != order[starts.back()].first) {
      starts.push_back(i);
    }
  }
  std::vector<BakedPoint> out(places.size());
  parallelFor(threads_, starts.size(), [&](std::size_t chunk) {
    const FlushDenormals flush;
    const std::size_t begin = starts[chunk];
    const std::size_t end = chunk + 1 < starts.size() ? starts[chunk + 1] : order.size();
    DirectPacket packet;
    packet.count = static_cast<int>(end - begin);
    for (int k = 0; k < packet.count; ++k) {
      const std::size_t i = order[begin + k].second;
      packet.position[k] = places[i].position;
      packet.normal[k] = places[i].normal;
      packet.random[k] = hash64(seed, i);
    }
    direct_.gather(packet);
    for (int k = 0; k < packet.count; ++k) {
      BakedPoint& point = out[order[begin + k].second];
      point.lux = packet.lux[k];
      point.flicker_lamp = packet.flicker_lamp[k];
      const float total = std::max(luminance(point.lux), 1e-6F);
      point.flicker_share =
          static_cast<std::uint16_t>(std::lround(packet.flicker_lux[k] / total * 65535.0F));
    }
  });
  return out;
}

double Baker::openFloorLux(const std::vector<Place>& places,
                           const std::vector<BakedPoint>& floor) const {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < places.size(); begin += kPacket) {
    RayPacket rays;
    rays.clear(kMaskSolid);
    const int lanes = static_cast<int>(std::min<std::size_t>(kPacket, places.size() - begin));
    for (int k = 0; k < lanes; ++k) {
      if (places[begin + k].used) {
        rays.set(k, places[begin + k].position, Eigen::Vector3f::UnitZ(), kHeadroom);
      }
    }
    tracer_.occlude(rays);
    for (int k = 0; k < lanes; ++k) {
      if (rays.valid[k] != 0 && rays.rays.ray.tfar[k] >= 0.0F) {
        sum += luminance(floor[begin + k].lux);
        ++count;
      }
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

BakedLight Baker::bake() {
  BakedLight out;
  // 1. Places that carry light: vertices of the structure and cars, cells of the floor.
  layFloor(coarse_, static_cast<float>(options_.indirect_cell));
  layFloor(out.floor_grid, static_cast<float>(options_.floor_cell));
  coarse_places_ = floorPlaces(coarse_);
  const std::vector<Place> fine_places = floorPlaces(out.floor_grid);
  std::vector<Place> places = vertexPlaces();
  places.insert(places.end(), coarse_places_.begin(), coarse_places_.end());
  coarse_albedo_.resize(coarse_.size(), Eigen::Vector3f::Constant(0.3F));
  if (scene_.floor != nullptr) {
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
      const Eigen::Vector2f c = coarse_.center(i);
      coarse_albedo_[i] = scene_.floor->sample(c.x(), c.y(), coarse_.cell).albedo;
    }
  }

  // 2. Direct light.
  const std::vector<BakedPoint> direct = directAt(places, 11);
  out.floor = directAt(fine_places, 12);

  std::size_t lit = 0;
  for (std::size_t i = vertex_count_; i < places.size(); ++i) {
    if (luminance(direct[i].lux) > 0.0F) {
      usual_lux_ += direct[i].lux;
      ++lit;
    }
  }
  usual_lux_ /= static_cast<float>(std::max<std::size_t>(lit, 1));

  // 3. Bounces: E = direct + G(E), a few times over the same rays.
  std::vector<Eigen::Vector3f> lux(places.size());
  std::vector<Eigen::Vector3f> indirect(places.size(), Eigen::Vector3f::Zero());
  if (options_.bounces > 0) {
    gatherHits(places);
  }
  for (int b = 0; b < options_.bounces; ++b) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      lux[i] = direct[i].lux + indirect[i];
    }
    indirect = bounce(lux);
  }
  std::vector<GatherHit>().swap(hits_);
  smooth(indirect);
  for (std::size_t i = 0; i < places.size(); ++i) {
    lux[i] = direct[i].lux + indirect[i];
  }
  bakeProbes(out, lux);

  // 4. Joined maps. The flickering lamp's share is of the sum.
  const auto join = [](BakedPoint& point, const Eigen::Vector3f& added) {
    const float before = luminance(point.lux);
    point.lux += added;
    const float ratio = before / std::max(luminance(point.lux), 1e-6F);
    point.flicker_share =
        static_cast<std::uint16_t>(std::lround(ratio * static_cast<float>(point.flicker_share)));
  };
  out.vertices.assign(direct.begin(), direct.begin() + static_cast<std::ptrdiff_t>(vertex_count_));
  for (std::size_t i = 0; i < vertex_count_; ++i) {
    if (places[i].used) {
      join(out.vertices[i], indirect[i]);
    }
  }
  lightVehicles(out);
  for (std::size_t i = 0; i < out.floor.size(); ++i) {
    std::array<std::uint32_t, 4> cells;
    std::array<float, 4> weights;
    const Eigen::Vector2f c = out.floor_grid.center(i);
    coarse_.bilinear(c.x(), c.y(), cells, weights);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int k = 0; k < 4; ++k) {
      sum += weights[k] * indirect[vertex_count_ + cells[k]];
    }
    join(out.floor[i], sum);
    out.floor_z.push_back(fine_places[i].position.z());
  }

  // 5. Scale to the wanted illuminance.
  out.raw_floor_lux = openFloorLux(fine_places, out.floor);
  PARKADE_CHECK(out.raw_floor_lux > 0.0, "no light reaches the floor ({} luminaires)",
                scene_.luminaires.size());
  const auto scale = static_cast<float>(scene_.target_floor_lux / out.raw_floor_lux);
  for (BakedPoint& point : out.vertices) {
    point.lux *= scale;
  }
  for (BakedPoint& point : out.floor) {
    point.lux *= scale;
  }
  for (auto& faces : out.probes.faces) {
    for (Eigen::Vector3f& face : faces) {
      face *= scale;
    }
  }
  out.mean_floor_lux = openFloorLux(fine_places, out.floor);
  return out;
}

BakedLight bakeLight(const Scene& scene, const StaticTracer& tracer, const BakeOptions& options,
                     int threads) {
  return Baker(scene, tracer, options, threads).bake();
}

}  // namespace parkade::sim
