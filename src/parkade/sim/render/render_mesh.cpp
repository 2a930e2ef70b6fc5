// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/render_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/sim/render/embree.hpp"
#include "parkade/sim/render/openness.hpp"

namespace parkade::sim {
namespace {

std::uint64_t packNormal(const Eigen::Vector3f& n) {
  std::uint64_t key = 0;
  for (int i = 0; i < 3; ++i) {
    key = key << 12 | static_cast<std::uint64_t>(std::lround(n[i] * 1000.0F) + 1500);
  }
  return key;
}

Eigen::Vector3f faceNormal(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3f& a = mesh.vertices[t.v[0]];
  const Eigen::Vector3f n = (mesh.vertices[t.v[1]] - a).cross(mesh.vertices[t.v[2]] - a);
  const float length = n.norm();
  return length > 0.0F ? Eigen::Vector3f(n / length) : Eigen::Vector3f(0.0F, 0.0F, 1.0F);
}

/// Square root of the texels on a square metre of the triangle; 0 without a texture.
float texelsPerMetre(const Mesh& mesh, const Triangle& t, const Scene& scene) {
  const Material& material = scene.materials.at(t.material);
  if (material.texture < 0) {
    return 0.0F;
  }
  const Texture& texture = scene.textures.at(static_cast<std::size_t>(material.texture));
  const Eigen::Vector3f a = mesh.vertices[t.v[1]] - mesh.vertices[t.v[0]];
  const Eigen::Vector3f b = mesh.vertices[t.v[2]] - mesh.vertices[t.v[0]];
  const Eigen::Vector2f ta = mesh.uvs[t.v[1]] - mesh.uvs[t.v[0]];
  const Eigen::Vector2f tb = mesh.uvs[t.v[2]] - mesh.uvs[t.v[0]];
  const float area = std::max(a.cross(b).norm(), 1e-12F);
  const float texels = std::abs(ta.x() * tb.y() - ta.y() * tb.x()) *
                       static_cast<float>(texture.width) * static_cast<float>(texture.height);
  return std::max(std::sqrt(texels / area), 1e-3F);
}

/// One vertex per (vertex, normal) of the mesh.
RenderMesh splitVertices(const Mesh& mesh, const Scene& scene) {
  const bool smooth = !mesh.normals.empty();
  const bool has_uvs = !mesh.uvs.empty();
  RenderMesh out;
  out.triangles.reserve(mesh.triangles.size());
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::uint32_t> seen;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3f face = faceNormal(mesh, triangle);
    RenderTriangle t;
    t.material = triangle.material;
    t.texels_per_metre = has_uvs ? texelsPerMetre(mesh, triangle, scene) : 0.0F;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = triangle.v[k];
      PARKADE_CHECK(v < mesh.vertices.size(), "vertex {} of {}", v, mesh.vertices.size());
      const Eigen::Vector3f n = smooth ? mesh.normals[v] : face;
      const auto [it, fresh] =
          seen.try_emplace({v, packNormal(n)}, static_cast<std::uint32_t>(out.positions.size()));
      if (fresh) {
        out.positions.push_back(mesh.vertices[v]);
        out.normals.push_back(n);
        out.uvs.push_back(has_uvs ? mesh.uvs[v] : Eigen::Vector2f(0.0F, 0.0F));
      }
      t.v[k] = it->second;
    }
    out.triangles.push_back(t);
  }
  return out;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;
struct EdgeHash {
  std::size_t operator()(const Edge& e) const { return hash64(e.first, e.second); }
};
using Midpoints = std::unordered_map<Edge, std::uint32_t, EdgeHash>;

Edge edgeOf(const RenderTriangle& t, int k) {
  const auto [low, high] = std::minmax(t.v[k], t.v[(k + 1) % 3]);
  return {low, high};
}

/// Replaces a triangle by those that its cut edges make. cut[k] is the new vertex between v[k] and
/// v[k + 1], or none.
void emitPieces(const RenderTriangle& t, const std::array<std::int64_t, 3>& cut,
                std::vector<RenderTriangle>& out) {
  const auto add = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
    RenderTriangle piece = t;
    piece.v[0] = static_cast<std::uint32_t>(a);
    piece.v[1] = static_cast<std::uint32_t>(b);
    piece.v[2] = static_cast<std::uint32_t>(c);
    out.push_back(piece);
  };
  const auto count = std::count_if(cut.begin(), cut.end(), [](auto c) { return c >= 0; });
  if (count == 0) {
    out.push_back(t);
    return;
  }
  // Turn the triangle so that the pattern starts at edge 0 (one cut, or the first of two cuts).
  int k = 0;
  const auto at = [&](int i) { return cut[(k + i) % 3]; };
  if (count == 1) {
    while (at(0) < 0) ++k;
  } else if (count == 2) {
    while (at(0) < 0 || at(1) < 0) ++k;
  }
  const std::int64_t a = t.v[k % 3];
  const std::int64_t b = t.v[(k + 1) % 3];
  const std::int64_t c = t.v[(k + 2) % 3];
  if (count == 1) {
    add(a, at(0), c);
    add(at(0), b, c);
  } else if (count == 2) {
    add(at(0), b, at(1));
    add(a, at(0), at(1));
    add(a, at(1), c);
  } else {
    add(a, at(0), at(2));
    add(at(0), b, at(1));
    add(at(2), at(1), c);
    add(at(0), at(1), at(2));
  }
}

std::uint32_t addMidpoint(RenderMesh& mesh, const Edge& e) {
  const auto index = static_cast<std::uint32_t>(mesh.positions.size());
  const Eigen::Vector3f position = 0.5F * (mesh.positions[e.first] + mesh.positions[e.second]);
  const Eigen::Vector3f normal = (mesh.normals[e.first] + mesh.normals[e.second]).normalized();
  const Eigen::Vector2f uv = 0.5F * (mesh.uvs[e.first] + mesh.uvs[e.second]);
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  mesh.uvs.push_back(uv);
  return index;
}

/// Cuts every edge longer than its triangle's limit once. Returns whether any was cut.
bool cutLongEdges(RenderMesh& mesh, const std::vector<float>& limit_of_material) {
  Midpoints midpoints;
  for (const RenderTriangle& t : mesh.triangles) {
    std::array<float, 3> length{};
    for (int k = 0; k < 3; ++k) {
      length[k] = (mesh.positions[t.v[k]] - mesh.positions[t.v[(k + 1) % 3]]).norm();
    }
    // Only the longer edges in one pass: thin triangles become well shaped ones.
    const float longest = *std::max_element(length.begin(), length.end());
    const float limit = limit_of_material[t.material];
    // Light hardly changes across a thin face (pipes, ducts, stripes): it gets longer pieces.
    const Eigen::Vector3f across = (mesh.positions[t.v[1]] - mesh.positions[t.v[0]])
                                       .cross(mesh.positions[t.v[2]] - mesh.positions[t.v[0]]);
    constexpr float kThin = 0.25F;
    constexpr float kLonger = 3.0F;
    const bool thin = across.norm() < kThin * limit * longest;
    const float longest_allowed = thin ? kLonger * limit : limit;
    for (int k = 0; k < 3; ++k) {
      if (length[k] > longest_allowed && length[k] > 0.8F * longest) {
        midpoints.try_emplace(edgeOf(t, k), 0U);
      }
    }
  }
  if (midpoints.empty()) {
    return false;
  }
  for (const RenderTriangle& t : mesh.triangles) {  // in the triangles' order: the same every time
    for (int k = 0; k < 3; ++k) {
      const auto it = midpoints.find(edgeOf(t, k));
      if (it != midpoints.end() && it->second == 0U) {
        it->second = addMidpoint(mesh, it->first);
      }
    }
  }
  std::vector<RenderTriangle> pieces;
  pieces.reserve(mesh.triangles.size() * 2);
  for (const RenderTriangle& t : mesh.triangles) {
    std::array<std::int64_t, 3> cut{-1, -1, -1};
    for (int k = 0; k < 3; ++k) {
      const auto it = midpoints.find(edgeOf(t, k));
      if (it != midpoints.end()) {
        cut[k] = it->second;
      }
    }
    emitPieces(t, cut, pieces);
  }
  mesh.triangles = std::move(pieces);
  return true;
}

}  // namespace

unsigned maskOf(const Material& material) {
  if (material.is_floor) {
    return kMaskFloor;
  }
  if (material.emission.maxCoeff() > 0.0F && material.label == SemanticClass::kCeiling) {
    return kMaskLamp;
  }
  if (material.label == SemanticClass::kCeiling || material.label == SemanticClass::kGuideSign) {
    return kMaskOverhead;
  }
  return kMaskSolid;
}

RenderMesh prepareMesh(const Mesh& mesh, const Scene& scene, const SubdivisionLimits& limits) {
  PARKADE_CHECK(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size(),
                "{} normals, {} vertices", mesh.normals.size(), mesh.vertices.size());
  PARKADE_CHECK(mesh.uvs.empty() || mesh.uvs.size() == mesh.vertices.size(), "{} uvs, {} vertices",
                mesh.uvs.size(), mesh.vertices.size());
  RenderMesh out = splitVertices(mesh, scene);
  std::vector<float> limit_of_material;
  for (const Material& material : scene.materials) {
    const unsigned mask = maskOf(material);
    // Floors have a map of their own; vehicles are lit from the probes and finely cut anyway.
    const bool uncut =
        mask == kMaskFloor || mask == kMaskLamp || material.label == SemanticClass::kVehicle;
    limit_of_material.push_back(uncut                   ? std::numeric_limits<float>::max()
                                : mask == kMaskOverhead ? limits.overhead
                                                        : limits.other);
  }
  while (cutLongEdges(out, limit_of_material)) {
  }
  return out;
}

StaticGeometry flatten(const Scene& scene, const SubdivisionLimits& limits, RTCDevice device) {
  std::vector<RenderMesh> prepared(scene.meshes.size());
  StaticGeometry out;
  for (const StaticObject& object : scene.objects) {
    const auto index = static_cast<std::size_t>(object.mesh);
    PARKADE_CHECK(index < scene.meshes.size(), "mesh {} of {}", object.mesh, scene.meshes.size());
    RenderMesh& mesh = prepared[index];
    if (mesh.triangles.empty()) {
      mesh = prepareMesh(scene.meshes[index], scene, limits);
      const bool vehicle =
          std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const RenderTriangle& t) {
            return scene.materials[t.material].label == SemanticClass::kVehicle;
          });
      mesh.openness =
          vehicle ? opennessOf(mesh, device) : std::vector<float>(mesh.positions.size(), 1.0F);
    }
    const auto base = static_cast<std::uint32_t>(out.mesh.positions.size());
    const Eigen::Matrix3d R = object.T_world_mesh.rotation().matrix();
    const Eigen::Vector3d& p = object.T_world_mesh.translation();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      out.mesh.positions.emplace_back((R * mesh.positions[i].cast<double>() + p).cast<float>());
      out.mesh.normals.emplace_back((R * mesh.normals[i].cast<double>()).cast<float>());
      out.mesh.uvs.push_back(mesh.uvs[i]);
      out.mesh.openness.push_back(mesh.openness[i]);
    }
    for (RenderTriangle t : mesh.triangles) {
      for (std::uint32_t& v : t.v) {
        v += base;
      }
      t.instance = object.instance;
      out.mesh.triangles.push_back(t);
    }
  }
  const auto group = [&](const RenderTriangle& t) { return maskOf(scene.materials[t.material]); };
  auto& triangles = out.mesh.triangles;
  std::stable_sort(triangles.begin(), triangles.end(),
                   [&](const auto& a, const auto& b) { return group(a) < group(b); });
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const unsigned mask = group(triangles[i]);
    if (out.groups.empty() || out.groups.back().mask != mask) {
      out.groups.push_back({mask, i, i});
    }
    out.groups.back().end = i + 1;
  }
  return out;
}

}  // namespace parkade::sim
