// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/shading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace parkade::sim {
namespace {

constexpr float kInvPi = std::numbers::inv_pi_v<float>;
constexpr int kMaxTaps = 4;
constexpr float kSoftness = 2.0F;   // diameter of a sample's footprint over the spacing of samples
constexpr float kDullFrom = 0.75F;  // roughness above which no mirror image is left

float flickerFactor(const BakedPoint& point, const Moment& moment) {
  if (point.flicker_lamp == kNoLamp) {
    return 1.0F;
  }
  const float brightness = moment.lamp_brightness[point.flicker_lamp];
  return 1.0F + (brightness - 1.0F) * static_cast<float>(point.flicker_share) * (1.0F / 65535.0F);
}

}  // namespace

float mirrorReflectance(float specular, float roughness, float cosine) {
  if (roughness >= kDullFrom) {
    return 0.0F;
  }
  const float m = 1.0F - std::min(cosine, 1.0F);
  const float m2 = m * m;
  const float grazing = std::max(1.0F - roughness, specular) - specular;
  const float fade = std::min(1.0F, 3.0F * (kDullFrom - roughness) / kDullFrom);
  return fade * (specular + grazing * m2 * m2 * m);
}

Shader::Shader(const Scene& scene, const StaticTracer& tracer, const BakedLight& light)
    : scene_(scene),
      mesh_(tracer.mesh()),
      light_(light),
      lamps_(scene, light.mean_floor_lux / light.raw_floor_lux) {
  textures_.reserve(scene.textures.size());
  for (const Texture& texture : scene.textures) {
    textures_.emplace_back(texture);
  }
  const auto lux = static_cast<float>(scene.target_floor_lux);
  for (const Material& material : scene.materials) {
    ShadeMaterial m;
    m.albedo = material.albedo;
    m.emission = material.emission * lux;
    m.specular = material.specular;
    m.roughness = material.roughness;
    m.texture =
        material.texture >= 0 ? &textures_[static_cast<std::size_t>(material.texture)] : nullptr;
    m.label = material.label;
    m.is_floor = material.is_floor && scene.floor != nullptr;
    materials_.push_back(m);
  }
  background_ = Eigen::Vector3f::Constant(0.02F * lux * kInvPi);
  const double scale = light.raw_floor_lux > 0.0 ? light.mean_floor_lux / light.raw_floor_lux : 1.0;
  sky_ = scene.daylight.present
             ? Eigen::Vector3f(Eigen::Vector3f(0.95F, 1.0F, 1.08F) * kInvPi *
                               scene.daylight.luminous_exitance * static_cast<float>(scale))
             : background_;
}

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

Eigen::Vector3f Shader::floorLux(float x, float y, const Moment& moment) const {
  std::array<std::uint32_t, 4> cells;
  std::array<float, 4> weights;
  light_.floor_grid.bilinear(x, y, cells, weights);
  Eigen::Vector3f lux = Eigen::Vector3f::Zero();
  if (moment.lamp_brightness.empty()) {
    for (std::size_t i = 0; i < 4; ++i) {
      lux += weights[i] * light_.floor[cells[i]].lux;
    }
  } else {
    for (std::size_t i = 0; i < 4; ++i) {
      const BakedPoint& point = light_.floor[cells[i]];
      lux += weights[i] * flickerFactor(point, moment) * point.lux;
    }
  }
  return lux;
}

Eigen::Vector3f Shader::bakedLux(const RenderTriangle& t, float u, float v,
                                 const Moment& moment) const {
  const BakedPoint& a = light_.vertices[t.v[0]];
  const BakedPoint& b = light_.vertices[t.v[1]];
  const BakedPoint& c = light_.vertices[t.v[2]];
  float wa = 1.0F - u - v;
  float wb = u;
  float wc = v;
  if (!moment.lamp_brightness.empty()) {
    wa *= flickerFactor(a, moment);
    wb *= flickerFactor(b, moment);
    wc *= flickerFactor(c, moment);
  }
  return wa * a.lux + wb * b.lux + wc * c.lux;
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

void Shader::shadeFloor(const SurfaceHit* const* hits, const Eigen::Vector3f* const* directions,
                        int count, const Eigen::Vector3f& eye, float spread, int samples,
                        const Moment& moment, Surface& out) const {
  // The footprint of a sample is an ellipse, longer along the ray by 1 / cosine: taps along it keep
  // the paint sharp across while they average along. They fill the gap to the next sample evenly,
  // which cancels the beat between paint and pixels. A lone sample needs more of them than one of
  // four, which the others complement.
  const Eigen::Vector3f& d = *directions[0];
  const float cosine = std::max(std::abs(d.dot(out.normal)), 0.02F);
  const float gap = samples > 1 ? 0.3F : 0.6F;
  const int taps = std::min(kMaxTaps, 1 + static_cast<int>(gap / cosine));
  const float pitch = spread * hits[0]->t / cosine;
  const float footprint = kSoftness * pitch * std::sqrt(cosine / static_cast<float>(taps));
  const float level = std::sqrt(std::max(d.x() * d.x() + d.y() * d.y(), 1e-12F));
  const float step = pitch / (static_cast<float>(taps) * level);
  const float step_x = step * d.x();
  const float step_y = step * d.y();
  const float start = -0.5F * static_cast<float>(taps - 1);
  Eigen::Vector3f albedo = Eigen::Vector3f::Zero();
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  float specular = 0.0F;
  float roughness = 0.0F;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f p = eye + hits[i]->t * *directions[i];
    middle += p;
    float x = p.x() + start * step_x;
    float y = p.y() + start * step_y;
    for (int k = 0; k < taps; ++k) {
      const FloorSample sample = scene_.floor->sample(x, y, footprint);
      albedo += sample.albedo;
      specular += sample.specular;
      roughness += sample.roughness;
      x += step_x;
      y += step_y;
    }
  }
  const float weight = 1.0F / static_cast<float>(taps * count);
  albedo *= weight;
  out.position = middle / static_cast<float>(count);
  out.specular = specular * weight;
  out.roughness = roughness * weight;
  out.is_floor = true;
  Eigen::Vector3f lux = floorLux(out.position.x(), out.position.y(), moment);
  if (!moment.objects.empty()) {
    lux *= moment.floorShade(out.position.x(), out.position.y());
  }
  if (!moment.beams.empty()) {
    lux += moment.beamLux(out.position, out.normal);
  }
  out.radiance = albedo.cwiseProduct(lux) * kInvPi;
}

void Shader::shade(const SurfaceHit* const* hits, const Eigen::Vector3f* const* directions,
                   int count, const Eigen::Vector3f& eye, float spread, int samples,
                   const Moment& moment, Surface& out) const {
  const SurfaceHit& hit = *hits[0];
  const RenderMesh& mesh = meshOf(hit, moment);
  const RenderTriangle& t = mesh.triangles[hit.triangle];
  const ShadeMaterial& material = materials_[t.material];
  const PlacedObject* object =
      hit.object < 0 ? nullptr : &moment.objects[static_cast<std::size_t>(hit.object)];
  const float w = 1.0F - hit.u - hit.v;
  out.normal =
      w * mesh.normals[t.v[0]] + hit.u * mesh.normals[t.v[1]] + hit.v * mesh.normals[t.v[2]];
  if (object != nullptr) {
    out.normal = object->R_world_object * out.normal;
  }
  out.normal.normalize();
  if (out.normal.dot(*directions[0]) > 0.0F) {
    out.normal = -out.normal;
  }
  if (material.is_floor) {
    shadeFloor(hits, directions, count, eye, spread, samples, moment, out);
    return;
  }
  out.position = eye + hit.t * *directions[0];
  out.specular = material.specular;
  out.roughness = material.roughness;
  out.is_floor = false;
  Eigen::Vector3f lux;
  if (object != nullptr) {
    const auto& vertex_lux = object->vertex_lux;
    lux = w * vertex_lux[t.v[0]] + hit.u * vertex_lux[t.v[1]] + hit.v * vertex_lux[t.v[2]];
  } else {
    lux = bakedLux(t, hit.u, hit.v, moment);
  }
  if (!moment.beams.empty()) {
    lux += moment.beamLux(out.position, out.normal);
  }
  Eigen::Vector3f albedo = material.albedo;
  Eigen::Vector3f emission = material.emission;
  if (material.texture != nullptr && t.texels_per_metre > 0.0F) {
    const float cosine = std::max(std::abs(directions[0]->dot(out.normal)), 0.1F);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int i = 0; i < count; ++i) {
      const SurfaceHit& h = *hits[i];
      const RenderTriangle& ti = mesh.triangles[h.triangle];
      const Eigen::Vector2f uv = (1.0F - h.u - h.v) * mesh.uvs[ti.v[0]] + h.u * mesh.uvs[ti.v[1]] +
                                 h.v * mesh.uvs[ti.v[2]];
      sum += material.texture->sample(uv.x(), uv.y(),
                                      spread * h.t * ti.texels_per_metre / std::sqrt(cosine));
    }
    sum /= static_cast<float>(count);
    albedo = albedo.cwiseProduct(sum);
    emission = emission.cwiseProduct(sum);
  }
  out.radiance = albedo.cwiseProduct(lux) * kInvPi + emission;
  if (!moment.lamp_brightness.empty() && material.emission.x() > 0.0F) {
    out.radiance *= lampBrightness(out.position, moment);
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
