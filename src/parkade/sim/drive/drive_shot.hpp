// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests of what a simulated drive shows: one moment of it, in small pictures.
#include <array>
#include <memory>
#include <ostream>
#include <vector>

#include "parkade/sim/drive/frame_renderer.hpp"

namespace parkade::sim::test {

struct Drive {
  const char* name;
  const char* address;
  double t;  ///< s: what the pictures show
};
inline std::ostream& operator<<(std::ostream& stream, const Drive& drive) {
  return stream << drive.name;
}

// Each sees paint of many kinds, pillars, parked and moving cars and people. These are many, since
// they are planned for the whole drive and few of them are near at one time.
inline constexpr std::array<Drive, 2> kDrives{
    Drive{"paper", "sim:paper/test2?duration=40&cars=6&people=16", 31.0},
    Drive{"random", "sim:random?garage_seed=5003&seed=5003&duration=40&cars=6&people=16", 20.0}};

inline constexpr double kSmall = 0.25;  // the rig's cameras, scaled: 160 x 100
inline constexpr int kGroundPx = 200;
inline constexpr double kGroundMetresPerPx = 0.08;

/// A moment of a drive, all of it made from its address.
class Shot {
 public:
  explicit Shot(const Drive& drive, int threads = 1, int bounces = 0) : t_(drive.t) {
    simulation_ = Simulation::make(parseSimAddress(drive.address).value()).value();
    scene_ = makeScene(*simulation_);
    RenderOptions options;
    options.threads = threads;
    // Labels do not depend on the light: it is as coarse as can be.
    options.bake.floor_cell = 1.0;
    options.bake.indirect_cell = 4.0;
    options.bake.gather_rays = 16;
    options.bake.bounces = bounces;
    renderer_ = std::make_unique<Renderer>(scene_, options);
    for (const RigCamera& camera : cameras()) {
      renderer_->addCamera(camera.camera.scaled(kSmall));
    }
    T_world_vehicle_ = simulation_->T_world_vehicle(t_);
    moment_ = renderer_->moment(t_, T_world_vehicle_);
  }

  [[nodiscard]] double t() const { return t_; }
  [[nodiscard]] const Simulation& simulation() const { return *simulation_; }
  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const std::vector<RigCamera>& cameras() const {
    return simulation_->trueRig().cameras;
  }
  [[nodiscard]] const SE3& T_world_vehicle() const { return T_world_vehicle_; }
  [[nodiscard]] SE3 T_world_cam(int camera) const {
    return T_world_vehicle_ * cameras().at(static_cast<std::size_t>(camera)).T_vehicle_cam;
  }
  [[nodiscard]] TruthImages truth(int camera) const {
    return renderer_->renderTruth(camera, T_world_cam(camera), *moment_);
  }
  [[nodiscard]] Radiance radiance(int camera) const {
    return renderer_->renderRadiance(camera, T_world_cam(camera), *moment_);
  }
  [[nodiscard]] OrthoImages ground() const {
    return renderer_->renderOrtho(T_world_vehicle_, kGroundPx, kGroundMetresPerPx, t_);
  }

 private:
  double t_;
  std::shared_ptr<const Simulation> simulation_;
  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<Renderer> renderer_;
  SE3 T_world_vehicle_;
  std::shared_ptr<const Moment> moment_;
};

}  // namespace parkade::sim::test
