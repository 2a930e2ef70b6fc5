// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// What shading reads per triangle and material, laid out once per scene.
#include <numbers>

#include "parkade/sim/render/shading.hpp"

namespace parkade::sim {

Shader::Shader(const Scene& scene, const StaticTracer& tracer, const BakedLight& light)
    : scene_(scene),
      mesh_(tracer.mesh()),
      light_(light),
      lamps_(scene, light.mean_floor_lux / light.raw_floor_lux) {
  textures_.reserve(scene.textures.size());
  for (const Texture& texture : scene.textures) {
    textures_.emplace_back(texture);
  }
  triangles_.resize(mesh_.triangles.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const RenderTriangle& source = mesh_.triangles[i];
    ShadeTriangle& t = triangles_[i];
    t.texels_per_metre = source.texels_per_metre;
    t.material = source.material;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = source.v[k];
      const BakedPoint& baked = light.vertices[v];
      float* const values = t.values.data();
      Eigen::Map<Eigen::Vector3f>(values + 3 * k) = baked.lux;
      Eigen::Map<Eigen::Vector3f>(values + ShadeTriangle::kNormals + 3 * k) = mesh_.normals[v];
      Eigen::Map<Eigen::Vector2f>(values + ShadeTriangle::kUvs + 2 * k) = mesh_.uvs[v];
      t.flicker_lamp[k] = baked.flicker_lamp;
      t.flicker_share[k] = baked.flicker_share;
    }
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
  background_ = Eigen::Vector3f::Constant(0.02F * lux * std::numbers::inv_pi_v<float>);
  const double scale = light.raw_floor_lux > 0.0 ? light.mean_floor_lux / light.raw_floor_lux : 1.0;
  sky_ = scene.daylight.present
             ? Eigen::Vector3f(Eigen::Vector3f(0.95F, 1.0F, 1.08F) * std::numbers::inv_pi_v<float> *
                               scene.daylight.luminous_exitance * static_cast<float>(scale))
             : background_;
}

}  // namespace parkade::sim
