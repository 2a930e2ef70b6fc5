// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/sim/render/embree.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

struct RenderTriangle {
  std::uint32_t v[3] = {0, 0, 0};
  std::uint16_t material = 0;
  std::uint32_t instance = 0;
  float texels_per_metre = 0.0F;  ///< of the material's texture; 0: untextured
};

/// A mesh as the renderer wants it: every vertex has one normal and one texture coordinate (flat
/// faces have vertices of their own), and large faces are cut so that light can be kept per vertex.
struct RenderMesh {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<RenderTriangle> triangles;
  /// Per vertex: share of its light that the object itself does not hide (0 to 1); empty until
  /// computed (openness.hpp).
  std::vector<float> openness;
};

/// Longest edges of triangles that light is baked on, m.
struct SubdivisionLimits {
  float overhead = 0.9F;  ///< ceiling
  float other = 0.7F;     ///< walls, pillars, cars
};

/// Splits vertices by normal and cuts long edges; floors, lamps and vehicles are left uncut. Edges
/// shared by two triangles are cut at the same place, so that no cracks open.
RenderMesh prepareMesh(const Mesh& mesh, const Scene& scene, const SubdivisionLimits& limits);

/// Which group of rays sees a material: one bit of RayMask.
unsigned maskOf(const Material& material);

/// All static objects as one mesh in world coordinates, its triangles ordered by ray mask group.
struct StaticGeometry {
  RenderMesh mesh;
  struct Group {
    unsigned mask = 0;
    std::uint32_t begin = 0;  ///< first triangle
    std::uint32_t end = 0;
  };
  std::vector<Group> groups;
};

StaticGeometry flatten(const Scene& scene, const SubdivisionLimits& limits, RTCDevice device);

}  // namespace parkade::sim
