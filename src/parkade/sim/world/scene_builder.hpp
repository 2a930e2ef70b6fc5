// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>

#include "parkade/camera/rig.hpp"
#include "parkade/core/options.hpp"
#include "parkade/sim/garage.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

struct SceneOptions {
  double lux = 200.0;
  int vehicles = 0;
  int pedestrians = 0;
  double wear = 1.0;
  double dirt = 1.0;
  bool furniture = true;
  int seed = 0;
  int agents_seed = 0;

  void visit(OptionVisitor& v) {
    v.field("lux", lux, "lx", "Mean illuminance of the open floor.", 0.1, 1e5);
    v.field("vehicles", vehicles, "count", "Cars that drive.", 0, 50);
    v.field("pedestrians", pedestrians, "count", "People who walk.", 0, 100);
    v.field("wear", wear, "", "Times the garage's own wear of paint; 0: fresh.", 0.0, 5.0);
    v.field("dirt", dirt, "", "Times the garage's own dirt; 0: clean.", 0.0, 5.0);
    v.field("furniture", furniture, "Ducts, pipes, posters, extinguishers and the like.");
    v.field("seed", seed, "", "Of bodies and places of parked cars.", 0, 1e9);
    v.field("agents_seed", agents_seed, "", "Of what moves.", 0, 1e9);
  }
};

/// The own car, for its body and for others to keep clear of it.
struct EgoInput {
  std::optional<VehicleShape> shape;              ///< none: no body is drawn
  std::function<Eigen::Vector3d(double t)> pose;  ///< x, y, yaw of its rear axle; or empty
  double duration = 0.0;                          ///< s; later the car stands
};

/// Everything that a renderer draws of a garage: building, paint, lamps, parked cars, what moves.
/// The same garage and options give the same scene.
Scene buildScene(const Garage& garage, const SceneOptions& options, const EgoInput& ego = {});

/// The floor with all paint of the garage; wear and dirt multiply those of the garage's style.
std::shared_ptr<const FloorSurface> buildFloor(const Garage& garage, double wear, double dirt);

}  // namespace parkade::sim
