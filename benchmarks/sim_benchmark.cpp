// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// The renderer in the paper's garage: time to bake the light, and per 640 x 400 picture.
//
//     build/release/parkade_sim_benchmark
#include <benchmark/benchmark.h>

#include <memory>
#include <numbers>

#include "parkade/sim/render/renderer.hpp"
#include "parkade/sim/world/generate.hpp"
#include "parkade/sim/world/scene_builder.hpp"

namespace parkade::sim {
namespace {

std::shared_ptr<const Scene> paperScene() {
  static const auto kScene = [] {
    const auto garage = generateGarage(GarageOptions{});
    SceneOptions options;
    options.vehicles = 2;
    options.pedestrians = 2;
    EgoInput ego;
    ego.shape = VehicleShape{};
    return std::make_shared<const Scene>(buildScene(garage.value(), options, ego));
  }();
  return kScene;
}

Camera wideCamera() {
  PinholeEquidistant::Parameters p;
  p.fx = p.fy = 230.0;
  p.cx = 319.5;
  p.cy = 199.5;
  return {CameraModel(PinholeEquidistant(p)), 640, 400};
}

/// A camera 1 m up that looks along a heading and 20 degrees down.
SE3 looking(const Eigen::Vector3d& position, double heading) {
  const SO3 R_world_body = SO3::fromYawPitchRoll(heading, 20.0 * std::numbers::pi / 180.0, 0.0);
  Eigen::Matrix3d R_body_cam;
  R_body_cam << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {R_world_body * SO3(R_body_cam), position};
}

void bake(benchmark::State& state) {
  for (auto _ : state) {
    RenderOptions options;
    options.threads = static_cast<int>(state.range(0));
    const Renderer renderer(paperScene(), options);
    state.counters["bake_s"] = renderer.bakeSeconds();
  }
}
BENCHMARK(bake)->Arg(2)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

/// Pictures all around at one place of an aisle; arguments: fast, threads.
void picture(benchmark::State& state) {
  RenderOptions options;
  options.fast = state.range(0) != 0;
  options.threads = static_cast<int>(state.range(1));
  Renderer renderer(paperScene(), options);
  const int camera = renderer.addCamera(wideCamera());
  const Garage garage = generateGarage(GarageOptions{}).value();
  const auto& edge = garage.aisles.edges.front();
  const Eigen::Vector2d p = 0.5 * (garage.aisles.nodes[static_cast<std::size_t>(edge.from)] +
                                   garage.aisles.nodes[static_cast<std::size_t>(edge.to)]);
  const auto moment = renderer.moment(0.0, std::nullopt);
  std::uint64_t frame = 0;
  for (auto _ : state) {
    const double heading = static_cast<double>(frame % 6) * std::numbers::pi / 3.0;
    benchmark::DoNotOptimize(
        renderer.render(camera, looking({p.x(), p.y(), 1.0}, heading), *moment, frame++));
  }
}
BENCHMARK(picture)
    ->ArgNames({"fast", "threads"})
    ->ArgsProduct({{0, 1}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace parkade::sim

BENCHMARK_MAIN();
