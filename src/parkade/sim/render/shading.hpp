// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/sim/render/lamp_map.hpp"
#include "parkade/sim/render/light_bake.hpp"
#include "parkade/sim/render/moment.hpp"
#include "parkade/sim/render/texture.hpp"
#include "parkade/sim/render/tracer.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

/// Where a ray ended.
struct SurfaceHit {
  std::uint32_t triangle = kNoTriangle;  ///< of the static mesh, or of the object's
  std::int32_t object = -1;              ///< index into Moment::objects; -1: static
  float u = 0.0F;
  float v = 0.0F;
  float t = 0.0F;                                              ///< m
  Eigen::Vector3f geometric_normal = Eigen::Vector3f::Zero();  ///< not unit
};

/// A material as the shading loop wants it.
struct ShadeMaterial {
  Eigen::Vector3f albedo = Eigen::Vector3f::Zero();
  Eigen::Vector3f emission = Eigen::Vector3f::Zero();  ///< cd/m^2
  float specular = 0.04F;
  float roughness = 0.8F;
  const MipTexture* texture = nullptr;
  SemanticClass label = SemanticClass::kUnknown;
  bool is_floor = false;
};

/// What shading reads of a vertex of the static mesh, in one place: fewer cache misses.
struct alignas(16) ShadeVertex {
  Eigen::Vector4f lux = Eigen::Vector4f::Zero();     ///< w: unused
  Eigen::Vector4f normal = Eigen::Vector4f::Zero();  ///< w: 0
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  std::uint16_t flicker_lamp = kNoLamp;
  std::uint16_t flicker_share = 0;  ///< of 65535
};

/// A surface ready for its final sum.
struct Surface {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();   ///< unit, towards the viewer
  Eigen::Vector3f radiance = Eigen::Vector3f::Zero();  ///< diffuse and emitted, cd/m^2
  float specular = 0.0F;
  float roughness = 1.0F;
  bool is_floor = false;
};

/// Reflectance of a clear coat seen at an angle: Schlick's formula, weakened by roughness at
/// grazing angles; none for dull surfaces.
float mirrorReflectance(float specular, float roughness, float cosine);

/// The look of everything in a scene at one moment. Thread-safe.
class Shader {
 public:
  Shader(const Scene& scene, const StaticTracer& tracer, const BakedLight& light);

  [[nodiscard]] const ShadeMaterial& materialOf(const SurfaceHit& hit, const Moment& moment) const {
    return materials_[triangleOf(hit, moment).material];
  }
  [[nodiscard]] const RenderTriangle& triangleOf(const SurfaceHit& hit,
                                                 const Moment& moment) const {
    return meshOf(hit, moment).triangles[hit.triangle];
  }

  /// Fetches what shade() will read of a hit: the triangle, and once that is there, its corners.
  /// Hits of a tile shaded much later wait less for memory.
  void prefetchTriangle(const SurfaceHit& hit) const {
    if (hit.object < 0 && hit.triangle != kNoTriangle) {
      __builtin_prefetch(&mesh_.triangles[hit.triangle]);
    }
  }
  void prefetchVertices(const SurfaceHit& hit) const {
    if (hit.object < 0 && hit.triangle != kNoTriangle) {
      for (const std::uint32_t v : mesh_.triangles[hit.triangle].v) {
        __builtin_prefetch(&vertices_[v]);
      }
    }
  }

  /// Shades samples of one pixel that hit one surface (same material and object, like normals) as
  /// one: light at the first hit, colour as the mean over all. spread is the angle between
  /// neighbouring samples, samples how many the pixel has.
  void shade(const SurfaceHit* const* hits, const Eigen::Vector3f* const* directions, int count,
             const Eigen::Vector3f& eye, float spread, int samples, const Moment& moment,
             Surface& out) const;

  /// Class of a hit at the exact place.
  [[nodiscard]] SemanticClass labelOf(const SurfaceHit& hit, const Eigen::Vector3f& position,
                                      const Moment& moment) const;
  /// Radiance of a ray that meets nothing: the sky where it leaves through the daylight's opening,
  /// dark elsewhere (gaps of the model).
  [[nodiscard]] Eigen::Vector3f missed(const Eigen::Vector3f& origin,
                                       const Eigen::Vector3f& direction) const;
  /// Height of the floor below a place, m.
  [[nodiscard]] float floorHeight(const Eigen::Vector3f& p) const {
    return light_.floor_z[light_.floor_grid.index(p.x(), p.y())];
  }
  [[nodiscard]] const LampMap& lamps() const { return lamps_; }

 private:
  [[nodiscard]] const RenderMesh& meshOf(const SurfaceHit& hit, const Moment& moment) const {
    return hit.object < 0 ? mesh_
                          : moment.objects[static_cast<std::size_t>(hit.object)].shape->mesh;
  }
  [[nodiscard]] Eigen::Vector3f floorLux(float x, float y, const Moment& moment) const;
  /// Normal and illuminance at a hit, not unit and not turned towards the viewer.
  void surfaceAt(const SurfaceHit& hit, const RenderTriangle& t, const Moment& moment,
                 Eigen::Vector3f& normal, Eigen::Vector3f& lux) const;
  [[nodiscard]] Eigen::Vector2f uvAt(const SurfaceHit& hit, const RenderTriangle& t,
                                     const RenderMesh& mesh) const;
  /// The mean of a texture over hits of one object, each filtered over spread times its distance.
  [[nodiscard]] Eigen::Vector3f textureAt(const SurfaceHit* const* hits, int count,
                                          const MipTexture& texture, float spread,
                                          const Moment& moment) const;
  void shadeFloor(const SurfaceHit* const* hits, const Eigen::Vector3f* const* directions,
                  int count, const Eigen::Vector3f& eye, float spread, int samples,
                  const Moment& moment, Surface& out) const;
  [[nodiscard]] float lampBrightness(const Eigen::Vector3f& p, const Moment& moment) const;

  const Scene& scene_;
  const RenderMesh& mesh_;
  const BakedLight& light_;
  LampMap lamps_;
  std::vector<ShadeVertex> vertices_;  ///< of the static mesh
  std::vector<MipTexture> textures_;
  std::vector<ShadeMaterial> materials_;
  Eigen::Vector3f background_;
  Eigen::Vector3f sky_;
};

}  // namespace parkade::sim
