// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "parkade/sim/render/floor_rays_kernel.hpp"
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

/// What shading reads of a triangle of the static mesh, in two neighbouring cache lines: its
/// corners' light and normals would else come from places far apart.
struct alignas(64) ShadeTriangle {
  static constexpr std::size_t kNormals = 9;
  static constexpr std::size_t kUvs = 18;
  /// Per corner: illuminance (3 each), normal (3 each), texture coordinates (2 each).
  std::array<float, 24> values{};
  float texels_per_metre = 0.0F;
  std::uint16_t material = 0;
  std::array<std::uint16_t, 3> flicker_lamp{kNoLamp, kNoLamp, kNoLamp};
  std::array<std::uint16_t, 3> flicker_share{};  ///< of 65535

  /// Three values that belong to a corner; the fourth is whatever follows them.
  [[nodiscard]] Eigen::Map<const Eigen::Vector4f> lux(std::size_t corner) const {
    return Eigen::Map<const Eigen::Vector4f>(values.data() + 3 * corner);
  }
  [[nodiscard]] Eigen::Map<const Eigen::Vector4f> normal(std::size_t corner) const {
    return Eigen::Map<const Eigen::Vector4f>(values.data() + kNormals + 3 * corner);
  }
  [[nodiscard]] Eigen::Map<const Eigen::Vector2f> uv(std::size_t corner) const {
    return Eigen::Map<const Eigen::Vector2f>(values.data() + kUvs + 2 * corner);
  }
};
static_assert(sizeof(ShadeTriangle) == 128);

/// A surface ready for its final sum.
struct Surface {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();   ///< unit, towards the viewer
  Eigen::Vector3f radiance = Eigen::Vector3f::Zero();  ///< diffuse and emitted, cd/m^2
  float specular = 0.0F;
  float roughness = 1.0F;
  bool is_floor = false;
};

/// Samples of a pixel at most.
inline constexpr int kMaxSamples = 4;

/// Samples of one pixel that hit one surface (same material and object, like normals).
struct SampleGroup {
  const SurfaceHit* hits = nullptr;                 ///< of the pixel
  const Eigen::Vector3f* directions = nullptr;      ///< of the pixel
  const Eigen::Vector3f* eye = nullptr;             ///< where the rays come from
  float spread = 0.0F;                              ///< rad between neighbouring samples
  std::array<std::uint8_t, kMaxSamples> members{};  ///< which of the pixel's samples
  std::uint8_t count = 1;                           ///< of members
  [[nodiscard]] const SurfaceHit& hit(int i) const {
    return hits[members[static_cast<std::size_t>(i)]];
  }
  [[nodiscard]] const Eigen::Vector3f& direction(int i) const {
    return directions[members[static_cast<std::size_t>(i)]];
  }
};

/// Reflectance of a clear coat seen at an angle: Schlick's formula, weakened by roughness at
/// grazing angles; none for dull surfaces.
inline float mirrorReflectance(float specular, float roughness, float cosine) {
  constexpr float kDullFrom = 0.75F;  // roughness above which no mirror image is left
  if (roughness >= kDullFrom) {
    return 0.0F;
  }
  const float m = 1.0F - std::min(cosine, 1.0F);
  const float m2 = m * m;
  const float grazing = std::max(1.0F - roughness, specular) - specular;
  const float fade = std::min(1.0F, 3.0F * (kDullFrom - roughness) / kDullFrom);
  return fade * (specular + grazing * m2 * m2 * m);
}

/// The look of everything in a scene at one moment. Thread-safe.
class Shader {
 public:
  Shader(const Scene& scene, const StaticTracer& tracer, const BakedLight& light);

  [[nodiscard]] const ShadeMaterial& materialOf(const SurfaceHit& hit, const Moment& moment) const {
    return materials_[materialIndex(hit, moment)];
  }
  [[nodiscard]] const RenderTriangle& triangleOf(const SurfaceHit& hit,
                                                 const Moment& moment) const {
    return meshOf(hit, moment).triangles[hit.triangle];
  }

  /// Index of a hit's material.
  [[nodiscard]] std::uint16_t materialIndex(const SurfaceHit& hit, const Moment& moment) const {
    return hit.object < 0 ? triangles_[hit.triangle].material : triangleOf(hit, moment).material;
  }

  /// Whether two hits are of one object and material and turned alike, to 10 degrees.
  [[nodiscard]] bool areOneSurface(const SurfaceHit& a, const SurfaceHit& b,
                                   const Moment& moment) const {
    if (a.object != b.object) return false;
    if (a.triangle == b.triangle) return true;
    if (a.triangle == kNoTriangle || b.triangle == kNoTriangle) return false;
    const Eigen::Vector3f& n = a.geometric_normal;
    const Eigen::Vector3f& m = b.geometric_normal;
    const float dot = n.dot(m);
    return materialIndex(a, moment) == materialIndex(b, moment) &&
           dot * dot >= 0.97F * n.squaredNorm() * m.squaredNorm();
  }

  /// Fetches what shade() will read of a hit. Hits of a tile shaded much later wait less for
  /// memory.
  void prefetch(const SurfaceHit& hit) const {
    if (hit.object < 0 && hit.triangle != kNoTriangle) {
      const auto* at = reinterpret_cast<const char*>(&triangles_[hit.triangle]);
      __builtin_prefetch(at);
      __builtin_prefetch(at + 64);
    }
  }

  /// Shades groups, each as one: light at the first hit, colour as the mean over all. samples:
  /// how many a pixel has. One surface per group.
  void shade(const SampleGroup* groups, int count, int samples, const Moment& moment,
             Surface* out) const;

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
  /// Normal and illuminance at a hit, not unit and not turned towards the viewer.
  void surfaceAt(const SurfaceHit& hit, const Moment& moment, Eigen::Vector3f& normal,
                 Eigen::Vector3f& lux) const;
  struct TexturePlace {
    Eigen::Vector2f uv;
    float texels_per_metre = 0.0F;  ///< 0: untextured
  };
  [[nodiscard]] TexturePlace texturePlaceAt(const SurfaceHit& hit, const Moment& moment) const;
  /// The mean of a texture over hits of one object, each filtered over spread times its distance;
  /// first: the place of the first.
  [[nodiscard]] Eigen::Vector3f textureAt(const SampleGroup& group, const MipTexture& texture,
                                          const TexturePlace& first, float spread,
                                          const Moment& moment) const;

  /// A group not on the floor, between its light and its texture.
  struct SolidGroup {
    const SampleGroup* group = nullptr;
    const ShadeMaterial* material = nullptr;
    Surface* out = nullptr;
    Eigen::Vector3f lux;
    TexturePlace first;
    float spread = 0.0F;
    bool at_once = false;  ///< one look-up, in texels
    MipTexture::Place texels;
  };
  /// All but the radiance and the light of head lamps.
  void lightUp(const Moment& moment, SolidGroup& solid) const;
  /// The light of head lamps, for up to kLightLanes groups.
  static void addBeams(SolidGroup* solids, std::size_t count, const Moment& moment);
  /// The radiance.
  void paintSolid(const SolidGroup& solid, const Moment& moment) const;

  /// Groups on the floor that are shaded together (floor_shading.cpp).
  struct FloorGroups {
    int count = 0;
    std::array<const SampleGroup*, FloorBlock::kGroups> groups;
    std::array<Surface*, FloorBlock::kGroups> out;
  };
  void shadeFloor(const FloorGroups& floor, int samples, const Moment& moment) const;
  /// Light of the floor's map between four cells.
  [[nodiscard]] Eigen::Vector3f floorLux(const GridPlaces& places, int k,
                                         const Moment& moment) const;
  void shadeChunk(const SampleGroup* groups, int count, int samples, const Moment& moment,
                  Surface* out) const;
  [[nodiscard]] static float flickerFactor(std::uint16_t lamp, std::uint16_t share,
                                           const Moment& moment);
  [[nodiscard]] float lampBrightness(const Eigen::Vector3f& p, const Moment& moment) const;

  const Scene& scene_;
  const RenderMesh& mesh_;
  const BakedLight& light_;
  LampMap lamps_;
  std::vector<ShadeTriangle> triangles_;  ///< of the static mesh
  std::vector<MipTexture> textures_;
  std::vector<ShadeMaterial> materials_;
  Eigen::Vector3f background_;
  Eigen::Vector3f sky_;
};

}  // namespace parkade::sim
