// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/light_bake.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/texture.hpp"

namespace parkade::sim {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kFar = 1.0e4F;          // m
constexpr float kProbeSpacing = 1.25F;  // m
constexpr float kHeadroom = 2.0F;       // m: floor with less above it is not open
constexpr std::uint32_t kFloorHit = 0x80000000U;
constexpr int kSmoothingPasses = 2;

struct Place {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  bool used = false;
};

/// What a gather ray met: a triangle and where on it, or a floor cell.
struct GatherHit {
  std::uint32_t target = kNoTriangle;
  std::uint8_t u = 0;
  std::uint8_t v = 0;
};

float radicalInverse(std::uint32_t i) {
  i = (i << 16U) | (i >> 16U);
  i = ((i & 0x55555555U) << 1U) | ((i & 0xAAAAAAAAU) >> 1U);
  i = ((i & 0x33333333U) << 2U) | ((i & 0xCCCCCCCCU) >> 2U);
  i = ((i & 0x0F0F0F0FU) << 4U) | ((i & 0xF0F0F0F0U) >> 4U);
  i = ((i & 0x00FF00FFU) << 8U) | ((i & 0xFF00FF00U) >> 8U);
  return static_cast<float>(i) * 2.3283064e-10F;
}

float fraction(float x) {
  return x - std::floor(x);
}
float uniformOf(std::uint64_t bits) {
  return static_cast<float>(bits >> 40U) * (1.0F / 16777216.0F);
}

/// How a triangle gets its light.
enum class Kind : std::uint8_t {
  kStructure,  ///< per vertex
  kVehicle,    ///< from the probes: cars have too many vertices
  kFloor,      ///< from the floor's map
  kLamp,       ///< not at all
};

class Baker {
 public:
  Baker(const Scene& scene, const StaticTracer& tracer, const BakeOptions& options, int threads)
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

  BakedLight bake();

 private:
  [[nodiscard]] Kind kindOf(const RenderTriangle& t) const { return kind_of_material_[t.material]; }
  void lightVehicles(BakedLight& out) const;
  void layFloor(FloorGrid& grid, float cell) const;
  /// Heights and normals of the floor at cell centres; unused where there is no floor.
  [[nodiscard]] std::vector<Place> floorPlaces(const FloorGrid& grid) const;
  [[nodiscard]] std::vector<Place> vertexPlaces() const;
  [[nodiscard]] std::vector<BakedPoint> directAt(const std::vector<Place>& places,
                                                 std::uint64_t seed) const;
  void gatherHits(const std::vector<Place>& places);
  [[nodiscard]] std::vector<Eigen::Vector3f> bounce(const std::vector<Eigen::Vector3f>& lux) const;
  [[nodiscard]] Eigen::Vector3f bounced(const GatherHit& hit,
                                        const std::vector<Eigen::Vector3f>& lux) const;
  void smooth(std::vector<Eigen::Vector3f>& lux) const;
  void bakeProbes(BakedLight& out, const std::vector<Eigen::Vector3f>& lux) const;
  [[nodiscard]] double openFloorLux(const std::vector<Place>& places,
                                    const std::vector<BakedPoint>& floor) const;

  const Scene& scene_;
  const StaticTracer& tracer_;
  const BakeOptions& options_;
  const int threads_;
  const DirectLight direct_;
  const std::size_t vertex_count_;
  std::vector<Eigen::Vector3f> albedo_of_material_;
  std::vector<Kind> kind_of_material_;
  Eigen::Vector3f usual_lux_ = Eigen::Vector3f::Zero();  ///< mean direct light on the floor
  FloorGrid coarse_;
  std::vector<Place> coarse_places_;
  std::vector<Eigen::Vector3f> coarse_albedo_;
  std::vector<GatherHit> hits_;
};

void Baker::layFloor(FloorGrid& grid, float cell) const {
  Eigen::Vector2f low = Eigen::Vector2f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector2f high = -low;
  const RenderMesh& mesh = tracer_.mesh();
  for (const RenderTriangle& t : mesh.triangles) {
    if (scene_.materials[t.material].is_floor) {
      for (const std::uint32_t v : t.v) {
        low = low.cwiseMin(mesh.positions[v].head<2>());
        high = high.cwiseMax(mesh.positions[v].head<2>());
      }
    }
  }
  PARKADE_CHECK(low.x() < high.x() && low.y() < high.y(), "the scene has no floor");
  grid.min = low;
  grid.cell = cell;
  grid.nx = std::max(2, static_cast<int>(std::ceil((high.x() - low.x()) / cell)));
  grid.ny = std::max(2, static_cast<int>(std::ceil((high.y() - low.y()) / cell)));
}

std::vector<Place> Baker::floorPlaces(const FloorGrid& grid) const {
  std::vector<Place> places(grid.size());
  parallelFor(threads_, (places.size() + kPacket - 1) / kPacket, [&](std::size_t chunk) {
    RayPacket rays;
    rays.clear(kMaskFloor);
    const std::size_t begin = chunk * kPacket;
    const int count = static_cast<int>(std::min<std::size_t>(kPacket, places.size() - begin));
    for (int k = 0; k < count; ++k) {
      const Eigen::Vector2f c = grid.center(begin + k);
      rays.set(k, {c.x(), c.y(), 100.0F}, -Eigen::Vector3f::UnitZ(), kFar);
    }
    tracer_.intersect(rays, true);
    for (int k = 0; k < count; ++k) {
      Place& place = places[begin + k];
      const Eigen::Vector2f c = grid.center(begin + k);
      place.position << c.x(), c.y(), 0.0F;
      if (tracer_.triangleOf(rays, k) != kNoTriangle) {
        place.used = true;
        place.position.z() = 100.0F - rays.rays.ray.tfar[k];
        const Eigen::Vector3f n = rays.geometricNormal(k).normalized();
        place.normal = n.z() < 0.0F ? Eigen::Vector3f(-n) : n;
      }
    }
  });
  return places;
}

std::vector<Place> Baker::vertexPlaces() const {
  const RenderMesh& mesh = tracer_.mesh();
  std::vector<Place> places(vertex_count_);
  std::vector<Eigen::Vector3f> inward(vertex_count_, Eigen::Vector3f::Zero());
  std::vector<float> faces(vertex_count_, 0.0F);
  for (const RenderTriangle& t : mesh.triangles) {
    if (kindOf(t) != Kind::kStructure) {
      continue;
    }
    const Eigen::Vector3f center =
        (mesh.positions[t.v[0]] + mesh.positions[t.v[1]] + mesh.positions[t.v[2]]) / 3.0F;
    for (const std::uint32_t v : t.v) {
      places[v].used = true;
      inward[v] += center - mesh.positions[v];
      faces[v] += 1.0F;
    }
  }
  for (std::size_t i = 0; i < vertex_count_; ++i) {
    if (!places[i].used) {
      continue;
    }
    // A little off the surface and towards the middle of its faces: a vertex in a corner would
    // otherwise lie inside the neighbouring wall or floor.
    Eigen::Vector3f shift = inward[i] / faces[i] * 0.2F;
    const float length = shift.norm();
    shift *= length > 0.04F ? 0.04F / length : 1.0F;
    places[i].normal = mesh.normals[i];
    places[i].position = mesh.positions[i] + shift + 0.01F * mesh.normals[i];
  }
  return places;
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

void Baker::gatherHits(const std::vector<Place>& places) {
  const int packets = (options_.gather_rays + kPacket - 1) / kPacket;
  const int rays_per_place = packets * kPacket;
  hits_.assign(places.size() * rays_per_place, GatherHit{});
  constexpr std::size_t kChunk = 64;
  parallelFor(threads_, (places.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const FlushDenormals flush;
    for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, places.size()); ++i) {
      if (!places[i].used) {
        continue;
      }
      const Eigen::Vector3f n = places[i].normal;
      const Eigen::Vector3f helper =
          std::abs(n.z()) < 0.9F ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitX();
      const Eigen::Vector3f x = n.cross(helper).normalized();
      const Eigen::Vector3f y = n.cross(x);
      const float shift_a = uniformOf(hash64(i, 1));
      const float shift_b = uniformOf(hash64(i, 2));
      for (int p = 0; p < packets; ++p) {
        RayPacket rays;
        rays.clear(kMaskAll);
        for (int k = 0; k < kPacket; ++k) {
          const int s = p * kPacket + k;
          const float a = fraction((s + 0.5F) / rays_per_place + shift_a);
          const float b = 2.0F * kPi * fraction(radicalInverse(s) + shift_b);
          const float r = std::sqrt(a);
          const Eigen::Vector3f d =
              r * std::cos(b) * x + r * std::sin(b) * y + std::sqrt(std::max(0.0F, 1.0F - a)) * n;
          rays.set(k, places[i].position, d, kFar);
        }
        tracer_.intersect(rays, false);
        for (int k = 0; k < kPacket; ++k) {
          const std::uint32_t triangle = tracer_.triangleOf(rays, k);
          if (triangle == kNoTriangle) {
            continue;
          }
          GatherHit& hit = hits_[i * rays_per_place + p * kPacket + k];
          if (scene_.materials[tracer_.mesh().triangles[triangle].material].is_floor) {
            const float t = rays.rays.ray.tfar[k];
            hit.target = kFloorHit | static_cast<std::uint32_t>(coarse_.index(
                                         rays.rays.ray.org_x[k] + t * rays.rays.ray.dir_x[k],
                                         rays.rays.ray.org_y[k] + t * rays.rays.ray.dir_y[k]));
          } else {
            hit.target = triangle;
            hit.u = static_cast<std::uint8_t>(rays.rays.hit.u[k] * 255.0F);
            hit.v = static_cast<std::uint8_t>(rays.rays.hit.v[k] * 255.0F);
          }
        }
      }
    }
  });
}

/// Albedo times illuminance where a gather ray ended: pi times the radiance it brings.
Eigen::Vector3f Baker::bounced(const GatherHit& hit,
                               const std::vector<Eigen::Vector3f>& lux) const {
  if (hit.target == kNoTriangle) {
    return Eigen::Vector3f::Zero();
  }
  if ((hit.target & kFloorHit) != 0U) {
    const std::uint32_t cell = hit.target & ~kFloorHit;
    return coarse_albedo_[cell].cwiseProduct(lux[vertex_count_ + cell]);
  }
  const RenderTriangle& t = tracer_.mesh().triangles[hit.target];
  if (kindOf(t) == Kind::kVehicle) {
    constexpr float kVehicleShare = 0.6F;  // of the floor's usual light, all sides alike
    return kVehicleShare * albedo_of_material_[t.material].cwiseProduct(usual_lux_);
  }
  const float u = static_cast<float>(hit.u) / 255.0F;
  const float v = static_cast<float>(hit.v) / 255.0F;
  const Eigen::Vector3f e = (1.0F - u - v) * lux[t.v[0]] + u * lux[t.v[1]] + v * lux[t.v[2]];
  return albedo_of_material_[t.material].cwiseProduct(e);
}

std::vector<Eigen::Vector3f> Baker::bounce(const std::vector<Eigen::Vector3f>& lux) const {
  std::vector<Eigen::Vector3f> out(lux.size());
  const std::size_t rays = hits_.size() / lux.size();
  constexpr std::size_t kChunk = 1024;
  parallelFor(threads_, (lux.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, lux.size()); ++i) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::size_t k = 0; k < rays; ++k) {
        sum += bounced(hits_[i * rays + k], lux);
      }
      out[i] = sum / static_cast<float>(rays);  // cosine-weighted directions: the plain mean
    }
  });
  return out;
}

/// Removes the gather's noise: means over mesh neighbours and over neighbouring floor cells.
void Baker::smooth(std::vector<Eigen::Vector3f>& lux) const {
  for (int pass = 0; pass < kSmoothingPasses; ++pass) {
    std::vector<Eigen::Vector3f> sum(lux);
    std::vector<float> weight(lux.size(), 1.0F);
    for (const RenderTriangle& t : tracer_.mesh().triangles) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = t.v[k];
        const std::uint32_t b = t.v[(k + 1) % 3];
        sum[a] += 0.5F * lux[b];
        sum[b] += 0.5F * lux[a];
        weight[a] += 0.5F;
        weight[b] += 0.5F;
      }
    }
    for (int y = 0; y < coarse_.ny; ++y) {
      for (int x = 0; x < coarse_.nx; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * coarse_.nx + x;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const int nx = x + dx;
            const int ny = y + dy;
            if ((dx == 0 && dy == 0) || nx < 0 || ny < 0 || nx >= coarse_.nx || ny >= coarse_.ny) {
              continue;
            }
            const std::size_t j = static_cast<std::size_t>(ny) * coarse_.nx + nx;
            if (coarse_places_[j].used) {
              sum[vertex_count_ + i] += 0.5F * lux[vertex_count_ + j];
              weight[vertex_count_ + i] += 0.5F;
            }
          }
        }
      }
    }
    for (std::size_t i = 0; i < lux.size(); ++i) {
      lux[i] = sum[i] / weight[i];
    }
  }
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

void Baker::bakeProbes(BakedLight& out, const std::vector<Eigen::Vector3f>& lux) const {
  constexpr int kLevels = ProbeGrid::kLevels;
  constexpr int kRays = 64;
  ProbeGrid& probes = out.probes;
  layFloor(probes.plane, kProbeSpacing);
  const std::vector<Place> ground = floorPlaces(probes.plane);
  probes.faces.resize(ground.size() * kLevels);
  for (const Place& place : ground) {
    probes.floor_z.push_back(place.position.z());
  }
  std::vector<std::uint8_t> inside(probes.faces.size(), 0);
  parallelFor(threads_, ground.size(), [&](std::size_t cell) {
    const FlushDenormals flush;
    for (int level = 0; level < kLevels; ++level) {
      const std::size_t at = cell * kLevels + level;
      const Eigen::Vector3f p =
          ground[cell].position + ProbeGrid::kHeights[level] * Eigen::Vector3f::UnitZ();
      auto& faces = probes.faces[at];
      faces.fill(Eigen::Vector3f::Zero());
      int backs = 0;
      for (int packet = 0; packet < kRays / kPacket; ++packet) {
        RayPacket rays;
        rays.clear(kMaskAll);
        Eigen::Vector3f directions[kPacket];
        for (int k = 0; k < kPacket; ++k) {
          const int s = packet * kPacket + k;
          const float z = 1.0F - 2.0F * (s + 0.5F) / kRays;
          const float b = 2.0F * kPi * radicalInverse(s);
          const float r = std::sqrt(1.0F - z * z);
          directions[k] << r * std::cos(b), r * std::sin(b), z;
          rays.set(k, p, directions[k], kFar);
        }
        tracer_.intersect(rays, false);
        for (int k = 0; k < kPacket; ++k) {
          const std::uint32_t triangle = tracer_.triangleOf(rays, k);
          if (triangle == kNoTriangle) {
            continue;
          }
          const RenderTriangle& t = tracer_.mesh().triangles[triangle];
          GatherHit hit{triangle, static_cast<std::uint8_t>(rays.rays.hit.u[k] * 255.0F),
                        static_cast<std::uint8_t>(rays.rays.hit.v[k] * 255.0F)};
          if (scene_.materials[t.material].is_floor) {
            const Eigen::Vector3f q = p + rays.rays.ray.tfar[k] * directions[k];
            hit.target = kFloorHit | static_cast<std::uint32_t>(coarse_.index(q.x(), q.y()));
          } else if (rays.geometricNormal(k).dot(directions[k]) > 0.0F) {
            ++backs;
          }
          const Eigen::Vector3f radiance = bounced(hit, lux) / kPi;
          for (int f = 0; f < 6; ++f) {
            const float c = directions[k][f / 2] * (f % 2 == 0 ? 1.0F : -1.0F);
            faces[f] += std::max(c, 0.0F) * (4.0F * kPi / kRays) * radiance;
          }
        }
      }
      inside[at] = backs > kRays / 4 || !ground[cell].used ? 1 : 0;
      DirectPacket packet;
      packet.count = 6;
      for (int f = 0; f < 6; ++f) {
        packet.position[f] = p;
        packet.normal[f] = Eigen::Vector3f::Zero();
        packet.normal[f][f / 2] = f % 2 == 0 ? 1.0F : -1.0F;
        packet.random[f] = hash64(at, f);
      }
      direct_.gather(packet);
      for (int f = 0; f < 6; ++f) {
        faces[f] += packet.lux[f];
      }
    }
  });
  // Probes inside pillars, walls or cars take the mean of their free neighbours.
  const std::vector<std::array<Eigen::Vector3f, 6>> original = probes.faces;
  for (int y = 0; y < probes.plane.ny; ++y) {
    for (int x = 0; x < probes.plane.nx; ++x) {
      for (int level = 0; level < kLevels; ++level) {
        const auto at = [&](int cx, int cy) {
          return (static_cast<std::size_t>(cy) * probes.plane.nx + cx) * kLevels + level;
        };
        if (inside[at(x, y)] == 0) {
          continue;
        }
        float count = 0.0F;
        std::array<Eigen::Vector3f, 6> sum;
        sum.fill(Eigen::Vector3f::Zero());
        for (int cy = std::max(0, y - 2); cy <= std::min(probes.plane.ny - 1, y + 2); ++cy) {
          for (int cx = std::max(0, x - 2); cx <= std::min(probes.plane.nx - 1, x + 2); ++cx) {
            if (inside[at(cx, cy)] == 0) {
              count += 1.0F;
              for (int f = 0; f < 6; ++f) {
                sum[f] += original[at(cx, cy)][f];
              }
            }
          }
        }
        for (int f = 0; f < 6 && count > 0.0F; ++f) {
          probes.faces[at(x, y)][f] = sum[f] / count;
        }
      }
    }
  }
}

/// Light of vehicles' vertices from the probes around, dimmed where the vehicle hides its own
/// surroundings.
void Baker::lightVehicles(BakedLight& out) const {
  const RenderMesh& mesh = tracer_.mesh();
  std::vector<std::uint8_t> vehicle(vertex_count_, 0);
  for (const RenderTriangle& t : mesh.triangles) {
    if (kindOf(t) == Kind::kVehicle) {
      for (const std::uint32_t v : t.v) {
        vehicle[v] = 1;
      }
    }
  }
  constexpr std::size_t kChunk = 4096;
  parallelFor(threads_, (vertex_count_ + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min((chunk + 1) * kChunk, vertex_count_);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      if (vehicle[i] != 0) {
        const auto cube = out.probes.cubeAt(mesh.positions[i]);
        out.vertices[i].lux = ProbeGrid::evaluate(cube, mesh.normals[i]) * mesh.openness[i];
      }
    }
  });
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

}  // namespace

BakedLight bakeLight(const Scene& scene, const StaticTracer& tracer, const BakeOptions& options,
                     int threads) {
  return Baker(scene, tracer, options, threads).bake();
}

}  // namespace parkade::sim
