// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/shading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace parkade::sim {
namespace {

constexpr float kInvPi = std::numbers::inv_pi_v<float>;
constexpr int kChunk = 256;  // groups sorted together

}  // namespace

Eigen::Vector3f Shader::missed(const Eigen::Vector3f& origin,
                               const Eigen::Vector3f& direction) const {
  const Scene::Daylight& day = scene_.daylight;
  const float approach = direction.dot(day.normal);
  if (!day.present || approach >= 0.0F) {
    return background_;
  }
  const float t = (day.center - origin).dot(day.normal) / approach;
  const Eigen::Vector3f q = origin + t * direction - day.center;
  const Eigen::Vector3f across = Eigen::Vector3f::UnitZ().cross(day.normal).normalized();
  const bool through =
      t > 0.0F && std::abs(q.z()) < 0.5F * day.height && std::abs(q.dot(across)) < 0.5F * day.width;
  return through ? sky_ : background_;
}

float Shader::flickerFactor(std::uint16_t lamp, std::uint16_t share, const Moment& moment) {
  if (lamp == kNoLamp) {
    return 1.0F;
  }
  const float brightness = moment.lamp_brightness[lamp];
  return 1.0F + (brightness - 1.0F) * static_cast<float>(share) * (1.0F / 65535.0F);
}

void Shader::surfaceAt(const SurfaceHit& hit, const Moment& moment, Eigen::Vector3f& normal,
                       Eigen::Vector3f& lux) const {
  float wa = 1.0F - hit.u - hit.v;
  float wb = hit.u;
  float wc = hit.v;
  if (hit.object >= 0) {
    const PlacedObject& object = moment.objects[static_cast<std::size_t>(hit.object)];
    const auto& v = object.shape->mesh.triangles[hit.triangle].v;
    const auto& normals = object.shape->mesh.normals;
    normal = object.R_world_object * (wa * normals[v[0]] + wb * normals[v[1]] + wc * normals[v[2]]);
    lux =
        wa * object.vertex_lux[v[0]] + wb * object.vertex_lux[v[1]] + wc * object.vertex_lux[v[2]];
    return;
  }
  const ShadeTriangle& t = triangles_[hit.triangle];
  const Eigen::Vector4f n = wa * t.normal(0) + wb * t.normal(1) + wc * t.normal(2);
  if (!moment.lamp_brightness.empty()) {
    wa *= flickerFactor(t.flicker_lamp[0], t.flicker_share[0], moment);
    wb *= flickerFactor(t.flicker_lamp[1], t.flicker_share[1], moment);
    wc *= flickerFactor(t.flicker_lamp[2], t.flicker_share[2], moment);
  }
  const Eigen::Vector4f e = wa * t.lux(0) + wb * t.lux(1) + wc * t.lux(2);
  normal = n.head<3>();
  lux = e.head<3>();
}

Shader::TexturePlace Shader::texturePlaceAt(const SurfaceHit& hit, const Moment& moment) const {
  const float w = 1.0F - hit.u - hit.v;
  if (hit.object < 0) {
    const ShadeTriangle& t = triangles_[hit.triangle];
    return {w * t.uv(0) + hit.u * t.uv(1) + hit.v * t.uv(2), t.texels_per_metre};
  }
  const RenderMesh& mesh = moment.objects[static_cast<std::size_t>(hit.object)].shape->mesh;
  const RenderTriangle& t = mesh.triangles[hit.triangle];
  return {w * mesh.uvs[t.v[0]] + hit.u * mesh.uvs[t.v[1]] + hit.v * mesh.uvs[t.v[2]],
          t.texels_per_metre};
}

Eigen::Vector3f Shader::textureAt(const SampleGroup& group, const MipTexture& texture,
                                  const TexturePlace& first, float spread,
                                  const Moment& moment) const {
  bool one_triangle = true;
  for (int i = 1; i < group.count; ++i) {
    one_triangle = one_triangle && group.hit(i).triangle == group.hit(0).triangle;
  }
  const float texels = spread * group.hit(0).t * first.texels_per_metre;
  constexpr float kMagnified = 0.4F;
  if (one_triangle && texels < kMagnified) {
    // Within one texel the mean of the samples is the sample at their mean.
    Eigen::Vector2f middle = first.uv;
    for (int i = 1; i < group.count; ++i) {
      middle += texturePlaceAt(group.hit(i), moment).uv;
    }
    middle /= static_cast<float>(group.count);
    return texture.sample(middle.x(), middle.y(), texels);
  }
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int i = 0; i < group.count; ++i) {
    const SurfaceHit& hit = group.hit(i);
    const TexturePlace place = i == 0 ? first : texturePlaceAt(hit, moment);
    sum += texture.sample(place.uv.x(), place.uv.y(), spread * hit.t * place.texels_per_metre);
  }
  return sum / static_cast<float>(group.count);
}

float Shader::lampBrightness(const Eigen::Vector3f& p, const Moment& moment) const {
  float nearest = 0.5F;  // m: a lamp's visible tube is that close to its luminaire
  float brightness = 1.0F;
  for (std::size_t i = 0; i < moment.lamp_brightness.size(); ++i) {
    if (moment.lamp_brightness[i] == 1.0F) {
      continue;
    }
    const Luminaire& lamp = scene_.luminaires[i];
    const Eigen::Vector3f along = lamp.end_b - lamp.end_a;
    const float s =
        std::clamp((p - lamp.end_a).dot(along) / std::max(along.squaredNorm(), 1e-6F), 0.0F, 1.0F);
    const float distance = (p - lamp.end_a - s * along).norm();
    if (distance < nearest) {
      nearest = distance;
      brightness = moment.lamp_brightness[i];
    }
  }
  return brightness;
}

void Shader::lightUp(const Moment& moment, SolidGroup& solid) const {
  const SampleGroup& group = *solid.group;
  const ShadeMaterial& material = *solid.material;
  const SurfaceHit& hit = group.hit(0);
  const Eigen::Vector3f& direction = group.direction(0);
  Surface& out = *solid.out;
  surfaceAt(hit, moment, out.normal, solid.lux);
  out.normal.normalize();
  if (out.normal.dot(direction) > 0.0F) {
    out.normal = -out.normal;
  }
  out.position = *group.eye + hit.t * direction;
  out.specular = material.specular;
  out.roughness = material.roughness;
  out.is_floor = false;
  solid.first.texels_per_metre = 0.0F;
  solid.at_once = false;
  if (material.texture == nullptr) {
    return;
  }
  solid.first = texturePlaceAt(hit, moment);
  if (solid.first.texels_per_metre <= 0.0F) {
    return;
  }
  const float cosine = std::max(std::abs(direction.dot(out.normal)), 0.1F);
  solid.spread = group.spread / std::sqrt(cosine);
  if (group.count == 1) {
    solid.at_once = true;
    material.texture->find(solid.first.uv.x(), solid.first.uv.y(),
                           solid.spread * hit.t * solid.first.texels_per_metre, solid.texels);
    solid.texels.prefetch();
  }
}

void Shader::addBeams(SolidGroup* solids, std::size_t count, const Moment& moment) {
  unsigned reach = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3f& p = solids[k].out->position;
    reach |= moment.reach_grid.at(p.x(), p.y());
  }
  if ((reach & ReachGrid::kBeams) == 0U) {
    return;
  }
  LightPoints points;
  for (std::size_t k = 0; k < kLightLanes; ++k) {
    const Surface& surface = *solids[k < count ? k : 0].out;
    points.x[k] = surface.position.x();
    points.y[k] = surface.position.y();
    points.z[k] = surface.position.z();
    points.normal_x[k] = surface.normal.x();
    points.normal_y[k] = surface.normal.y();
    points.normal_z[k] = surface.normal.z();
  }
  alignas(64) std::array<float, kLightLanes> lux;
  moment.beamLux(reach, points, lux.data());
  for (std::size_t k = 0; k < count; ++k) {
    solids[k].lux += kBeamColour * lux[k];
  }
}

void Shader::paintSolid(const SolidGroup& solid, const Moment& moment) const {
  const ShadeMaterial& material = *solid.material;
  Surface& out = *solid.out;
  Eigen::Vector3f albedo = material.albedo;
  Eigen::Vector3f emission = material.emission;
  if (solid.first.texels_per_metre > 0.0F) {
    const Eigen::Vector3f mean = solid.at_once ? MipTexture::read(solid.texels)
                                               : textureAt(*solid.group, *material.texture,
                                                           solid.first, solid.spread, moment);
    albedo = albedo.cwiseProduct(mean);
    emission = emission.cwiseProduct(mean);
  }
  out.radiance = albedo.cwiseProduct(solid.lux) * kInvPi + emission;
  if (!moment.lamp_brightness.empty() && material.emission.x() > 0.0F) {
    out.radiance *= lampBrightness(out.position, moment);
  }
}

void Shader::shade(const SampleGroup* groups, int count, int samples, const Moment& moment,
                   Surface* out) const {
  for (int begin = 0; begin < count; begin += kChunk) {
    shadeChunk(groups + begin, std::min(kChunk, count - begin), samples, moment, out + begin);
  }
}

void Shader::shadeChunk(const SampleGroup* groups, int count, int samples, const Moment& moment,
                        Surface* out) const {
  // Sorted by kind, without branches: groups of one kind take the same way through the code.
  enum Kind : std::size_t { kFloor, kPlain, kTextured, kKinds };
  std::array<std::array<std::uint16_t, kChunk>, kKinds> order;
  std::array<std::size_t, kKinds> end{};
  for (int i = 0; i < count; ++i) {
    const ShadeMaterial& material = materialOf(groups[i].hit(0), moment);
    const std::size_t solid = material.texture == nullptr ? kPlain : kTextured;
    const std::size_t kind = material.is_floor ? kFloor : solid;
    order[kind][end[kind]++] = static_cast<std::uint16_t>(i);
  }
  FloorGroups floor;
  for (std::size_t begin = 0; begin < end[kFloor]; begin += FloorBlock::kGroups) {
    const std::size_t size = std::min<std::size_t>(FloorBlock::kGroups, end[kFloor] - begin);
    floor.count = static_cast<int>(size);
    for (std::size_t k = 0; k < size; ++k) {
      floor.groups[k] = &groups[order[kFloor][begin + k]];
      floor.out[k] = &out[order[kFloor][begin + k]];
    }
    shadeFloor(floor, samples, moment);
  }
  std::array<SolidGroup, kLightLanes> solids;
  for (const Kind kind : {kPlain, kTextured}) {
    for (std::size_t begin = 0; begin < end[kind]; begin += solids.size()) {
      const std::size_t size = std::min(solids.size(), end[kind] - begin);
      for (std::size_t k = 0; k < size; ++k) {
        SolidGroup& solid = solids[k];
        solid.group = &groups[order[kind][begin + k]];
        solid.out = &out[order[kind][begin + k]];
        solid.material = &materialOf(solid.group->hit(0), moment);
        lightUp(moment, solid);
      }
      addBeams(solids.data(), size, moment);
      for (std::size_t k = 0; k < size; ++k) {
        paintSolid(solids[k], moment);
      }
    }
  }
}

SemanticClass Shader::labelOf(const SurfaceHit& hit, const Eigen::Vector3f& position,
                              const Moment& moment) const {
  if (hit.triangle == kNoTriangle) {
    return SemanticClass::kUnknown;
  }
  if (hit.object >= 0) {
    return moment.objects[static_cast<std::size_t>(hit.object)].label;
  }
  const ShadeMaterial& material = materialOf(hit, moment);
  return material.is_floor ? scene_.floor->sample(position.x(), position.y(), 0.0F).label
                           : material.label;
}

}  // namespace parkade::sim
