// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/sim/scene.hpp"

namespace parkade::sim {

/// Builds a mesh piece by piece. Outsides are counter-clockwise as seen from there.
class MeshBuilder {
 public:
  /// A new vertex with its normal (unit) and texture coordinates; its index.
  std::uint32_t vertex(const Eigen::Vector3f& p, const Eigen::Vector3f& normal,
                       const Eigen::Vector2f& uv = Eigen::Vector2f::Zero());
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint16_t material);

  /// A flat quadrilateral a b c d; uv (0, 0) at a, (1, 0) at b, (1, 1) at c, times uv_size.
  void quad(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
            const Eigen::Vector3f& d, std::uint16_t material,
            const Eigen::Vector2f& uv_size = Eigen::Vector2f::Ones());

  /// A flat convex polygon.
  void polygon(const std::vector<Eigen::Vector3f>& points, std::uint16_t material);

  /// A box with its six faces; half sizes along x, y, z, turned by yaw (rad).
  void box(const Eigen::Vector3f& center, const Eigen::Vector3f& half, std::uint16_t material,
           float yaw = 0.0F);

  /// A tube from a to b with two radii, smooth around, with flat ends where capped.
  void cone(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a, float radius_b,
            int sides, std::uint16_t material, bool capped = true);

  /// An ellipsoid.
  void ellipsoid(const Eigen::Vector3f& center, const Eigen::Vector3f& radii, int rings, int sides,
                 std::uint16_t material);

  /// Adds another mesh, moved.
  void append(const Mesh& mesh, const Eigen::Matrix3f& rotation,
              const Eigen::Vector3f& translation);

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] Mesh take() { return std::move(mesh_); }

 private:
  Mesh mesh_;
};

/// Replaces the normals by area-weighted means over vertices at the same place (to 0.1 mm) whose
/// faces meet at less than crease (rad).
void smoothNormals(Mesh& mesh, float crease);

}  // namespace parkade::sim
