// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Projection and un-projection of every camera model through the variant, as the pipeline calls
// them.
#include <benchmark/benchmark.h>

#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/random.hpp"

namespace parkade {
namespace {

Camera cameraOf(const std::string& rig) {
  return readRig(std::string(PARKADE_SOURCE_DIR) + "/config/rigs/" + rig + ".yaml")
      .value()
      .cameras[0]
      .camera;
}

const char* const kRigs[] = {"euroc", "avp6", "garage_fisheye_sim", "garage_fisheye_real"};

struct Samples {
  std::vector<Eigen::Vector2d> pixels;
  std::vector<Eigen::Vector3d> rays;
};

Samples sample(const Camera& camera) {
  Random random(1);
  Samples samples;
  while (samples.rays.size() < 1024) {
    const Eigen::Vector2d pixel(random.uniform(0.0, camera.width() - 1.0),
                                random.uniform(0.0, camera.height() - 1.0));
    Eigen::Vector3d ray;
    if (!camera.unproject(pixel, ray)) continue;
    samples.pixels.push_back(pixel);
    samples.rays.push_back(ray * random.uniform(0.5, 20.0));
  }
  return samples;
}

void project(benchmark::State& state) {
  const Camera camera = cameraOf(kRigs[state.range(0)]);
  const Samples samples = sample(camera);
  const bool with_jacobian = state.range(1) != 0;
  state.SetLabel(camera.modelName());
  Eigen::Matrix<double, 2, 3> jacobian;
  for (auto _ : state) {
    double sum = 0.0;
    for (const Eigen::Vector3d& ray : samples.rays) {
      Eigen::Vector2d pixel;
      if (camera.project(ray, pixel, with_jacobian ? &jacobian : nullptr)) sum += pixel.x();
      if (with_jacobian) sum += jacobian(0, 2);
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples.rays.size()));
}
BENCHMARK(project)->ArgsProduct({{0, 1, 2, 3}, {0, 1}})->ArgNames({"rig", "jacobian"});

void unproject(benchmark::State& state) {
  const Camera camera = cameraOf(kRigs[state.range(0)]);
  const Samples samples = sample(camera);
  state.SetLabel(camera.modelName());
  for (auto _ : state) {
    double sum = 0.0;
    for (const Eigen::Vector2d& pixel : samples.pixels) {
      Eigen::Vector3d ray;
      if (camera.unproject(pixel, ray)) sum += ray.x();
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples.pixels.size()));
}
BENCHMARK(unproject)->DenseRange(0, 3)->ArgName("rig");

}  // namespace
}  // namespace parkade

BENCHMARK_MAIN();
