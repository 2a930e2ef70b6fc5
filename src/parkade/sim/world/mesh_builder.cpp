// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/mesh_builder.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "parkade/core/check.hpp"

namespace parkade::sim {
namespace {

constexpr float kTwoPi = 2.0F * std::numbers::pi_v<float>;

// Two unit vectors that make a right-handed frame with a unit axis: u x v = axis.
void frameAround(const Eigen::Vector3f& axis, Eigen::Vector3f& u, Eigen::Vector3f& v) {
  const Eigen::Vector3f helper =
      std::abs(axis.z()) < 0.9F ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitX();
  u = helper.cross(axis).normalized();
  v = axis.cross(u);
}

}  // namespace

std::uint32_t MeshBuilder::vertex(const Eigen::Vector3f& p, const Eigen::Vector3f& normal,
                                  const Eigen::Vector2f& uv) {
  mesh_.vertices.push_back(p);
  mesh_.normals.push_back(normal);
  mesh_.uvs.push_back(uv);
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                           std::uint16_t material) {
  Triangle t;
  t.v[0] = a;
  t.v[1] = b;
  t.v[2] = c;
  t.material = material;
  mesh_.triangles.push_back(t);
}

void MeshBuilder::quad(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                       const Eigen::Vector3f& d, std::uint16_t material,
                       const Eigen::Vector2f& uv_size) {
  // The diagonals' cross product is the normal of a quadrilateral, one with two equal corners too.
  const Eigen::Vector3f normal = (c - a).cross(d - b).normalized();
  const std::uint32_t i = vertex(a, normal, {0.0F, 0.0F});
  vertex(b, normal, {uv_size.x(), 0.0F});
  vertex(c, normal, uv_size);
  vertex(d, normal, {0.0F, uv_size.y()});
  triangle(i, i + 1, i + 2, material);
  triangle(i, i + 2, i + 3, material);
}

void MeshBuilder::polygon(const std::vector<Eigen::Vector3f>& points, std::uint16_t material) {
  PARKADE_CHECK(points.size() >= 3, "a polygon of {} points", points.size());
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    normal += points[i].cross(points[(i + 1) % points.size()]);
  }
  normal.normalize();
  const std::uint32_t first = vertex(points[0], normal);
  for (std::size_t i = 1; i < points.size(); ++i) vertex(points[i], normal);
  for (std::uint32_t i = 1; i + 1 < points.size(); ++i) {
    triangle(first, first + i, first + i + 1, material);
  }
}

void MeshBuilder::box(const Eigen::Vector3f& center, const Eigen::Vector3f& half,
                      std::uint16_t material, float yaw) {
  const Eigen::Matrix3f R = Eigen::AngleAxisf(yaw, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  const auto corner = [&](float x, float y, float z) -> Eigen::Vector3f {
    return center + R * Eigen::Vector3f(x * half.x(), y * half.y(), z * half.z());
  };
  quad(corner(1, -1, -1), corner(1, 1, -1), corner(1, 1, 1), corner(1, -1, 1), material);
  quad(corner(-1, 1, -1), corner(-1, -1, -1), corner(-1, -1, 1), corner(-1, 1, 1), material);
  quad(corner(1, 1, -1), corner(-1, 1, -1), corner(-1, 1, 1), corner(1, 1, 1), material);
  quad(corner(-1, -1, -1), corner(1, -1, -1), corner(1, -1, 1), corner(-1, -1, 1), material);
  quad(corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 1), corner(-1, 1, 1), material);
  quad(corner(-1, 1, -1), corner(1, 1, -1), corner(1, -1, -1), corner(-1, -1, -1), material);
}

void MeshBuilder::cone(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a,
                       float radius_b, int sides, std::uint16_t material, bool capped) {
  PARKADE_CHECK(sides >= 3, "a tube of {} sides", sides);
  const Eigen::Vector3f axis = (b - a).normalized();
  const float slope = (radius_a - radius_b) / (b - a).norm();
  Eigen::Vector3f u;
  Eigen::Vector3f v;
  frameAround(axis, u, v);
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (int i = 0; i <= sides; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(sides);
    const Eigen::Vector3f out = std::cos(kTwoPi * share) * u + std::sin(kTwoPi * share) * v;
    const Eigen::Vector3f normal = (out + slope * axis).normalized();
    vertex(a + radius_a * out, normal, {share, 0.0F});
    vertex(b + radius_b * out, normal, {share, 1.0F});
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(sides); ++i) {
    const std::uint32_t at = first + 2 * i;
    triangle(at, at + 2, at + 3, material);
    triangle(at, at + 3, at + 1, material);
  }
  if (!capped) return;
  std::vector<Eigen::Vector3f> end_a;
  std::vector<Eigen::Vector3f> end_b;
  for (int i = 0; i < sides; ++i) {
    end_a.push_back(mesh_.vertices[first + 2 * static_cast<std::uint32_t>(sides - 1 - i)]);
    end_b.push_back(mesh_.vertices[first + 2 * static_cast<std::uint32_t>(i) + 1]);
  }
  if (radius_a > 0.0F) polygon(end_a, material);
  if (radius_b > 0.0F) polygon(end_b, material);
}

void MeshBuilder::ellipsoid(const Eigen::Vector3f& center, const Eigen::Vector3f& radii, int rings,
                            int sides, std::uint16_t material) {
  PARKADE_CHECK(rings >= 2 && sides >= 3, "an ellipsoid of {} x {} faces", rings, sides);
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (int r = 0; r <= rings; ++r) {
    const float polar = 0.5F * kTwoPi * static_cast<float>(r) / static_cast<float>(rings);
    for (int s = 0; s <= sides; ++s) {
      const float around = kTwoPi * static_cast<float>(s) / static_cast<float>(sides);
      const Eigen::Vector3f unit(std::sin(polar) * std::cos(around),
                                 std::sin(polar) * std::sin(around), -std::cos(polar));
      vertex(center + radii.cwiseProduct(unit), unit.cwiseQuotient(radii).normalized());
    }
  }
  const auto stride = static_cast<std::uint32_t>(sides + 1);
  for (std::uint32_t r = 0; r < static_cast<std::uint32_t>(rings); ++r) {
    for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(sides); ++s) {
      const std::uint32_t at = first + r * stride + s;
      triangle(at, at + 1, at + stride + 1, material);
      triangle(at, at + stride + 1, at + stride, material);
    }
  }
}

void MeshBuilder::append(const Mesh& mesh, const Eigen::Matrix3f& rotation,
                         const Eigen::Vector3f& translation) {
  const auto offset = static_cast<std::uint32_t>(mesh_.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    vertex(rotation * mesh.vertices[i] + translation, rotation * mesh.normals[i],
           mesh.uvs.empty() ? Eigen::Vector2f(Eigen::Vector2f::Zero()) : mesh.uvs[i]);
  }
  for (const Triangle& t : mesh.triangles) {
    triangle(t.v[0] + offset, t.v[1] + offset, t.v[2] + offset, t.material);
  }
}

void smoothNormals(Mesh& mesh, float crease) {
  using Key = std::array<int, 3>;
  const auto keyOf = [](const Eigen::Vector3f& p) {
    constexpr float kPerMetre = 1e4F;
    return Key{static_cast<int>(std::lround(p.x() * kPerMetre)),
               static_cast<int>(std::lround(p.y() * kPerMetre)),
               static_cast<int>(std::lround(p.z() * kPerMetre))};
  };
  std::map<Key, std::vector<Eigen::Vector3f>> faces;  // area-weighted normals at each place
  std::vector<Eigen::Vector3f> own(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[t.v[0]];
    const Eigen::Vector3f n = (mesh.vertices[t.v[1]] - a).cross(mesh.vertices[t.v[2]] - a);
    for (const std::uint32_t i : t.v) {
      faces[keyOf(mesh.vertices[i])].push_back(n);
      own[i] += n;
    }
  }
  const float least = std::cos(crease);
  mesh.normals.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    // A vertex of faces without area only: any normal will do, nothing of it is seen.
    const Eigen::Vector3f mine = own[i].norm() > 1e-12F ? Eigen::Vector3f(own[i].normalized())
                                                        : Eigen::Vector3f(Eigen::Vector3f::UnitZ());
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& n : faces[keyOf(mesh.vertices[i])]) {
      if (n.normalized().dot(mine) >= least) sum += n;
    }
    mesh.normals[i] = sum.norm() > 1e-12F ? Eigen::Vector3f(sum.normalized()) : mine;
  }
}

}  // namespace parkade::sim
