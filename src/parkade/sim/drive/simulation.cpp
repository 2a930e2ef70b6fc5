// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/simulation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "parkade/core/random.hpp"
#include "parkade/core/units.hpp"
#include "parkade/sim/drive/imu_model.hpp"
#include "parkade/sim/drive/rig_presets.hpp"
#include "parkade/sim/world/generate.hpp"

namespace parkade::sim {
namespace {

constexpr double kWheelRate = 100.0;        // Hz
constexpr double kDefaultFrameRate = 10.0;  // Hz, where the rig does not say

Random randomOfSeed(const SimSpec& spec) {
  return Random(static_cast<std::uint64_t>(spec.seed)).fork("drive");
}

// What the sensors, the load and the stops draw is another for each garage and route: twenty drives
// of one seed with the same inertial noise and the same passengers would tell of one car on one
// day.
Random randomOf(const SimSpec& spec) {
  return randomOfSeed(spec)
      .fork(spec.garage, static_cast<std::uint64_t>(spec.garage_seed))
      .fork(spec.route);
}

SuspensionOptions suspensionOf(const VehicleShape& car, const SimSpec& spec) {
  SuspensionOptions options;
  options.wheelbase = car.wheelbase;
  options.track = car.track;
  options.roughness_seed = hash64(static_cast<std::uint64_t>(spec.garage_seed), 7);
  if (spec.load) {
    Random draws = randomOf(spec).fork("load");
    options.static_pitch_deg = std::clamp(draws.normal(0.0, 0.4), -1.0, 1.0);
    options.static_roll_deg = std::clamp(draws.normal(0.0, 0.2), -0.5, 0.5);
    options.static_heave = -std::abs(draws.normal(0.0, 0.01));
  }
  return options;
}

// Another rig for each garage and seed: garages driven with one wrong rig would tell of that rig.
Rig disturbed(const Rig& rig, const SimSpec& spec) {
  Rig told = rig;
  const Random car =
      randomOfSeed(spec).fork("calibration", static_cast<std::uint64_t>(spec.garage_seed));
  for (std::size_t i = 0; i < told.cameras.size(); ++i) {
    Random draws = car.fork("camera", i);
    Vector6d error;
    for (int k = 0; k < 3; ++k) error[k] = draws.normal() * 0.01 * spec.calib_error_cm;
    for (int k = 3; k < 6; ++k) error[k] = draws.normal() * kDegree * spec.calib_error_deg;
    if (error.isZero()) continue;
    SE3& T_vehicle_cam = told.cameras[i].T_vehicle_cam;
    // Errors along the vehicle's axes, about the camera's own place.
    T_vehicle_cam = SE3(SO3::exp(error.tail<3>()) * T_vehicle_cam.rotation(),
                        T_vehicle_cam.translation() + error.head<3>());
  }
  return told;
}

// The slot that the car parks in must be free; its car goes to another free slot.
void freeSlot(Garage& garage, int slot_id, Random random) {
  std::vector<Slot*> free;
  Slot* wanted = nullptr;
  for (Slot& slot : garage.slots) {
    if (slot.id == slot_id) wanted = &slot;
    if (slot.id != slot_id && !slot.occupied) free.push_back(&slot);
  }
  if (wanted == nullptr || !wanted->occupied) return;
  wanted->occupied = false;
  if (!free.empty()) free[random.index(free.size())]->occupied = true;
}

}  // namespace

Result<std::shared_ptr<const Simulation>> Simulation::make(const SimSpec& spec) {
  const std::shared_ptr<Simulation> simulation(new Simulation());
  simulation->spec_ = spec;
  Result<Rig> rig = loadRig(spec.rig);
  if (!rig) return rig.error();
  simulation->true_rig_ = std::move(rig).value();
  if (spec.readout_ms > 0.0) {
    for (RigCamera& camera : simulation->true_rig_.cameras) {
      camera.readout_time = 1e-3 * spec.readout_ms;
    }
  }
  simulation->told_rig_ = disturbed(simulation->true_rig_, spec);

  GarageOptions garage_options;
  garage_options.preset = spec.garage;
  garage_options.seed = spec.garage_seed;
  garage_options.parked_seed = spec.parkedSeed();
  garage_options.occupancy = spec.occupancy;
  garage_options.one_way = spec.one_way;
  garage_options.first_zone = spec.first_zone;
  Result<Garage> garage = generateGarage(garage_options);
  if (!garage) return garage.error();
  simulation->garage_ = std::move(garage).value();

  const VehicleShape car = simulation->true_rig_.vehicle.value_or(VehicleShape{});
  Result<Route> route =
      planRoute(simulation->garage_, spec.route, static_cast<std::uint64_t>(spec.seed), car);
  if (!route) return Error{fmt::format("{}: {}", spec.name(), route.error().message)};
  simulation->route_ = std::move(route).value();
  if (simulation->route_.parking_slot_id >= 0) {
    freeSlot(simulation->garage_, simulation->route_.parking_slot_id,
             randomOf(spec).fork("parking"));
  }
  const SuspensionOptions suspension = suspensionOf(car, spec);
  simulation->drive(suspension);
  simulation->sense(suspension);
  return std::shared_ptr<const Simulation>(simulation);
}

void Simulation::drive(const SuspensionOptions& suspension) {
  SpeedOptions speed;
  speed.max_speed = spec_.speed_kmh / 3.6;
  speed.max_reverse_speed = std::min(speed.max_reverse_speed, speed.max_speed);
  Random draws = randomOf(spec_).fork("standstill");
  speed.start_standstill = draws.uniform(1.0, 2.0);
  speed.end_standstill = draws.uniform(1.0, 2.0);
  profile_ = SpeedProfile(route_.path, route_.stops, route_.limits, speed);
  const Garage& garage = garage_;
  motion_ = std::make_unique<const VehicleMotion>(
      route_.path, profile_,
      [&garage](const Eigen::Vector2d& p) { return garage.surfaceHeight(p); }, suspension);
  if (spec_.rolling_start) {
    // Whole frames, so that stamps do not depend on where the drive is entered.
    constexpr double kRolling = 2.0;  // m/s
    while (offset_ < 0.5 * profile_.duration() && profile_.speed(offset_) < kRolling) {
      offset_ += 0.1;
    }
  }
  duration_ = wholeDuration();
  if (spec_.duration > 0.0) duration_ = std::min(duration_, spec_.duration);
}

void Simulation::sense(const SuspensionOptions& suspension) {
  const Random random = randomOf(spec_);
  ImuErrorOptions imu_errors;
  imu_errors.noise = spec_.noise;
  WheelErrorOptions wheel_errors;
  wheel_errors.noise = spec_.noise;
  const Garage& garage = garage_;
  const SurfaceHeight surface = [&garage](const Eigen::Vector2d& p) {
    return garage.surfaceHeight(p);
  };
  const auto stampsAt = [this](double rate, double first) {
    std::vector<TimeNs> stamps;
    for (std::int64_t k = 0;; ++k) {
      const TimeNs t_ns = fromSeconds(first + static_cast<double>(k) / rate);
      if (toSeconds(t_ns) > duration_) return stamps;
      stamps.push_back(t_ns);
    }
  };
  NoisyImu imu(true_rig_.imu, imu_errors, random);
  for (const TimeNs t_ns : stampsAt(true_rig_.imu.rate_hz, 0.0)) {
    const MotionState state = motionAt(toSeconds(t_ns));
    imu_.push_back(imu.corrupt(idealImu(state, true_rig_.imu.T_vehicle_imu, kSimStartNs + t_ns)));
    truth_.push_back({kSimStartNs + t_ns, state.T_world_vehicle, state.velocity_world,
                      imu.gyroBias(), imu.accelBias()});
  }
  const NoisyWheels wheels(wheel_errors, random);
  for (const TimeNs t_ns : stampsAt(kWheelRate, 0.0)) {
    const WheelState state =
        wheelState(route_.path, profile_, surface, suspension, toSeconds(t_ns) + offset_);
    wheel_.push_back(wheels.corrupt(state, kSimStartNs + t_ns));
  }
  const double told_rate = true_rig_.cameras.empty() ? 0.0 : true_rig_.cameras[0].rate_hz;
  const double rate = told_rate > 0.0 ? told_rate : kDefaultFrameRate;
  // The first picture comes after some inertial samples, the last before the last.
  for (const TimeNs t_ns : stampsAt(rate, 0.5 / rate)) frame_times_.push_back(kSimStartNs + t_ns);
}

double Simulation::drivenDistance() const {
  return profile_.distance(offset_ + duration_) - profile_.distance(offset_);
}

}  // namespace parkade::sim
