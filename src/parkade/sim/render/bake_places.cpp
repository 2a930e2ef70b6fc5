// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/baker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/core/check.hpp"
#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {
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

}  // namespace parkade::sim
