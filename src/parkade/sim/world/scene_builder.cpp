// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/scene_builder.hpp"

#include "parkade/core/check.hpp"
#include "parkade/sim/world/agents.hpp"
#include "parkade/sim/world/car_mesh.hpp"
#include "parkade/sim/world/parked_cars.hpp"
#include "parkade/sim/world/structure.hpp"
#include "parkade/sim/world/style.hpp"

namespace parkade::sim {
namespace {

void addDaylight(const Garage& garage, const GarageStyle& style, Scene& scene) {
  if (garage.entrances.empty() || !style.daylight) return;
  const Entrance& entrance = garage.entrances.front();
  Scene::Daylight& day = scene.daylight;
  day.present = true;
  day.normal = point3({std::cos(entrance.heading), std::sin(entrance.heading)}, 0.0);
  day.center =
      point3(entrance.center, garage.floorHeight(entrance.center) + 1.2) - 0.3F * day.normal;
  day.width = static_cast<float>(entrance.width);
  day.height = 2.2F;
}

}  // namespace

Scene buildScene(const Garage& garage, const SceneOptions& options, const EgoInput& ego) {
  PARKADE_CHECK(options.lux > 0.0, "lux is {}", options.lux);
  Scene scene;
  scene.target_floor_lux = options.lux;
  const GarageStyle style = makeStyle(garage.name, garage.seed);
  const Random random = Random(garage.seed).fork("scene", static_cast<std::uint64_t>(options.seed));
  Palette palette(scene);
  MeshBuilder mesh;
  // The building does not depend on the options' seed: it is the same in every drive.
  const Random building = Random(garage.seed).fork("building");
  addShell(garage, style, building.fork("shell"), palette, mesh);
  addPillars(garage, style, palette, mesh);
  addSigns(garage, style, palette, mesh);
  addRubber(garage, palette, mesh);
  if (options.furniture) addServices(garage, style, building.fork("services"), palette, mesh);
  addLamps(garage, style, building.fork("lamps"), palette, mesh);
  scene.meshes.push_back(mesh.take());
  scene.objects.push_back({0, SE3(), 0});
  addDaylight(garage, style, scene);
  CarMaterials materials = addCarMaterials(scene);
  addParkedCars(garage, materials, random.fork("parked"), scene);
  if (ego.shape) {
    materials.paint = addCarPaint(scene, {0.55F, 0.56F, 0.57F}, true);
    scene.ego_mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(egoCarMesh(*ego.shape, materials));
  }
  addAgents(garage, options.vehicles, options.pedestrians, ego, materials,
            Random(garage.seed).fork("agents", static_cast<std::uint64_t>(options.agents_seed)),
            scene);
  scene.floor = buildFloor(garage, options.wear, options.dirt);
  return scene;
}

}  // namespace parkade::sim
