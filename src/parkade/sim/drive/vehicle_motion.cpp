// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/vehicle_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/core/units.hpp"

namespace parkade::sim {
namespace {

constexpr double kControlStep = 0.01;  // s between control points of the truth
constexpr int kSubSteps = 5;           // of the suspension's integration within one

// Unevenness of the ground: plane waves of 0.4 to 6 m length in all directions, the long ones
// higher.
class Roughness {
 public:
  Roughness(double sigma, std::uint64_t seed) {
    if (sigma <= 0.0) return;
    Random random(hash64(seed, 0x726f7567));
    double variance = 0.0;
    for (Wave& wave : waves_) {
      const double length = 0.4 * std::pow(15.0, random.uniform());
      const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
      wave.k = 2.0 * std::numbers::pi / length *
               Eigen::Vector2d(std::cos(direction), std::sin(direction));
      wave.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
      wave.amplitude = length;
      variance += 0.5 * length * length;
    }
    for (Wave& wave : waves_) wave.amplitude *= sigma / std::sqrt(variance);
    present_ = true;
  }

  [[nodiscard]] double height(const Eigen::Vector2d& p) const {
    double sum = 0.0;
    if (!present_) return sum;
    for (const Wave& wave : waves_) sum += wave.amplitude * std::sin(wave.k.dot(p) + wave.phase);
    return sum;
  }

 private:
  struct Wave {
    Eigen::Vector2d k = Eigen::Vector2d::Zero();
    double phase = 0.0;
    double amplitude = 0.0;
  };
  std::array<Wave, 24> waves_;
  bool present_ = false;
};

// A mass on a spring and damper: x'' = w^2 (target - x) + 2 z w (damper_speed - x').
struct Oscillator {
  double x = 0.0;
  double v = 0.0;

  void advance(double target, double damper_speed, double hz, double damping, double dt) {
    const double w = 2.0 * std::numbers::pi * hz;
    // Semi-implicit: the damper at the step's end, stable for every step used here.
    const double a = w * w * (target - x) + 2.0 * damping * w * damper_speed;
    v = (v + dt * a) / (1.0 + 2.0 * damping * w * dt);
    x += dt * v;
  }
};

// How high a rigid wheel's hub is lifted over its resting height: it rolls over edges.
double lift(const SurfaceHeight& surface, const Eigen::Vector2d& contact, double heading,
            double radius) {
  constexpr int kHalf = 6;
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  double most = surface(contact);
  for (int i = -kHalf; i <= kHalf; ++i) {
    const double d = 0.5 * radius * i / kHalf;
    if (i == 0) continue;
    const double sag = radius - std::sqrt(radius * radius - d * d);
    most = std::max(most, surface(contact + d * along) - sag);
  }
  return most;
}

// Heave, pitch and roll of the body over time.
class Suspension {
 public:
  Suspension(const SurfaceHeight& surface, const SuspensionOptions& options)
      : surface_(surface),
        options_(options),
        roughness_(options.road_roughness, options.roughness_seed) {}

  void rest(const PathPoint& axle) {
    const std::array<double, 4> heights = wheelHeights(axle);
    for (int i = 0; i < 4; ++i) wheels_[i] = {heights[i], 0.0};
    const Eigen::Vector3d plane = planeOf(heights) + loads(0.0, 0.0);
    for (int i = 0; i < 3; ++i) body_[i] = {plane[i], 0.0};
  }

  void advance(const PathPoint& axle, double longitudinal, double lateral, double dt) {
    const std::array<double, 4> heights = wheelHeights(axle);
    std::array<double, 4> x{};
    std::array<double, 4> v{};
    for (int i = 0; i < 4; ++i) {
      wheels_[i].advance(heights[i], 0.0, options_.wheel_hz, 0.5, dt);
      x[i] = wheels_[i].x;
      v[i] = wheels_[i].v;
    }
    const Eigen::Vector3d target = planeOf(x) + loads(longitudinal, lateral);
    const Eigen::Vector3d speed = planeOf(v);
    const std::array<double, 3> hz{options_.heave_hz, options_.pitch_hz, options_.roll_hz};
    for (int i = 0; i < 3; ++i) {
      body_[i].advance(target[i], speed[i], hz[i], options_.damping, dt);
    }
  }

  // Height of the ground below the car's middle as the body feels it, pitch, roll.
  [[nodiscard]] Eigen::Vector3d state() const { return {body_[0].x, body_[1].x, body_[2].x}; }

 private:
  // Rear left, rear right, front left, front right.
  [[nodiscard]] std::array<double, 4> wheelHeights(const PathPoint& axle) const {
    const Eigen::Vector2d forward(std::cos(axle.heading), std::sin(axle.heading));
    const Eigen::Vector2d left(-forward.y(), forward.x());
    std::array<double, 4> heights{};
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector2d contact = axle.position + (i < 2 ? 0.0 : options_.wheelbase) * forward +
                                      (i % 2 == 0 ? 0.5 : -0.5) * options_.track * left;
      heights[i] =
          lift(surface_, contact, axle.heading, options_.wheel_radius) + roughness_.height(contact);
    }
    return heights;
  }

  // Mean height, pitch (nose down > 0) and roll (right side down > 0) of four wheels.
  [[nodiscard]] Eigen::Vector3d planeOf(const std::array<double, 4>& h) const {
    return {0.25 * (h[0] + h[1] + h[2] + h[3]),
            0.5 * (h[0] + h[1] - h[2] - h[3]) / options_.wheelbase,
            0.5 * (h[0] + h[2] - h[1] - h[3]) / options_.track};
  }

  [[nodiscard]] Eigen::Vector3d loads(double longitudinal, double lateral) const {
    return {options_.static_heave,
            kDegree * (options_.static_pitch_deg -
                       options_.pitch_gradient_deg_per_g * longitudinal / kGravity),
            kDegree *
                (options_.static_roll_deg + options_.roll_gradient_deg_per_g * lateral / kGravity)};
  }

  const SurfaceHeight& surface_;
  const SuspensionOptions& options_;
  Roughness roughness_;
  std::array<Oscillator, 4> wheels_;
  std::array<Oscillator, 3> body_;
};

SO3 rotationOf(const Eigen::Vector3d& yaw_pitch_roll) {
  return SO3::fromYawPitchRoll(yaw_pitch_roll[0], yaw_pitch_roll[1], yaw_pitch_roll[2]);
}

// Maps the rates of yaw, pitch and roll to the angular velocity in the body frame, and its rate.
struct EulerRates {
  Eigen::Matrix3d map;
  Eigen::Matrix3d map_rate;

  EulerRates(const Eigen::Vector3d& angles, const Eigen::Vector3d& rates) {
    const double sp = std::sin(angles[1]), cp = std::cos(angles[1]);
    const double sr = std::sin(angles[2]), cr = std::cos(angles[2]);
    map << -sp, 0, 1, cp * sr, cr, 0, cp * cr, -sr, 0;
    const double dp = rates[1], dr = rates[2];
    map_rate << -cp * dp, 0, 0, -sp * dp * sr + cp * cr * dr, -sr * dr, 0,
        -sp * dp * cr - cp * sr * dr, -cr * dr, 0;
  }
};

}  // namespace

VehicleMotion::VehicleMotion(const Path& path, const SpeedProfile& profile,
                             const SurfaceHeight& surface, const SuspensionOptions& options)
    : center_body_(0.5 * options.wheelbase, 0.0, options.center_height),
      duration_(profile.duration()) {
  constexpr int kMargin = UniformSpline<6>::kMargin;
  const double start = -kMargin * kControlStep;
  const int count = static_cast<int>(std::ceil(duration_ / kControlStep)) + 2 * kMargin + 1;
  Suspension suspension(surface, options);
  suspension.rest(path.at(0.0));
  std::vector<UniformSpline<6>::Vector> points(count);
  for (int i = 0; i < count; ++i) {
    const double t = start + i * kControlStep;
    const PathPoint axle = path.at(profile.distance(t));
    const Eigen::Vector3d body = suspension.state();
    const double forward = 0.5 * options.wheelbase;
    points[i] << axle.position.x() + forward * std::cos(axle.heading),
        axle.position.y() + forward * std::sin(axle.heading), body[0] + options.center_height,
        axle.heading, body[1], body[2];
    for (int k = 0; k < kSubSteps; ++k) {
      const double at = t + kControlStep * (k + 1) / kSubSteps;
      const PathPoint point = path.at(profile.distance(at));
      const double v = profile.speed(at);
      suspension.advance(point, point.direction * profile.acceleration(at), v * v * point.curvature,
                         kControlStep / kSubSteps);
    }
  }
  spline_ = UniformSpline<6>(start, kControlStep, std::move(points));
}

MotionState VehicleMotion::at(double t) const {
  const double clamped = std::clamp(t, 0.0, duration_);
  const auto value = spline_.evaluate(clamped);
  const auto first = spline_.evaluate(clamped, 1);
  const auto second = spline_.evaluate(clamped, 2);
  const SO3 R = rotationOf(value.tail<3>());
  const EulerRates euler(value.tail<3>(), first.tail<3>());
  MotionState state;
  const Eigen::Vector3d w = euler.map * first.tail<3>();
  const Eigen::Vector3d dw = euler.map * second.tail<3>() + euler.map_rate * first.tail<3>();
  const Eigen::Vector3d lever = -center_body_;
  state.T_world_vehicle = SE3(R, value.head<3>() + R * lever);
  state.velocity_world = first.head<3>() + R * w.cross(lever);
  state.acceleration_world = second.head<3>() + R * (dw.cross(lever) + w.cross(w.cross(lever)));
  state.angular_velocity_body = w;
  state.angular_acceleration_body = dw;
  return state;
}

SE3 VehicleMotion::pose(double t) const {
  const auto value = spline_.evaluate(std::clamp(t, 0.0, duration_));
  const SO3 R = rotationOf(value.tail<3>());
  return {R, value.head<3>() - R * center_body_};
}

WheelState wheelState(const Path& path, const SpeedProfile& profile, const SurfaceHeight& surface,
                      const SuspensionOptions& options, double t) {
  const PathPoint axle = path.at(profile.distance(t));
  const double speed = axle.direction * profile.speed(t);
  // The path is measured in the plane; wheels roll along the slope.
  constexpr double kReach = 0.25;  // m
  const Eigen::Vector2d along(std::cos(axle.heading), std::sin(axle.heading));
  const double slope =
      (surface(axle.position + kReach * along) - surface(axle.position - kReach * along)) /
      (2.0 * kReach);
  const double ground = speed * std::sqrt(1.0 + slope * slope);
  const double difference = 0.5 * options.track * axle.curvature;
  return {ground * (1.0 - difference), ground * (1.0 + difference),
          std::atan(options.wheelbase * axle.curvature)};
}

}  // namespace parkade::sim
