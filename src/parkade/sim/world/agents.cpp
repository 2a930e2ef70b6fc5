// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/agents.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "parkade/sim/world/agent_motion.hpp"
#include "parkade/sim/world/agent_tracks.hpp"
#include "parkade/sim/world/parked_cars.hpp"
#include "parkade/sim/world/person_mesh.hpp"

namespace parkade::sim {
namespace {

constexpr int kCandidates = 6;
constexpr double kDefaultDuration = 120.0;  // s, where nobody drives

/// An agent's whole motion.
struct Motion {
  AgentTrack track;
  AgentSchedule schedule;

  [[nodiscard]] Eigen::Vector3d pose(double t) const { return track.at(schedule.distance(t)); }
};

// Seconds during which the own car could see it: near and mostly ahead or beside.
double timeInView(const Motion& motion, const EgoInput& ego, double duration, double near) {
  if (!ego.pose) return 0.0;
  double seconds = 0.0;
  constexpr double kStep = 0.5;
  for (double t = 0.0; t < duration; t += kStep) {
    const double distance = (motion.pose(t).head<2>() - ego.pose(t).head<2>()).norm();
    if (distance < near) seconds += kStep;
  }
  return seconds;
}

std::vector<MovingBox> egoBoxes(const EgoInput& ego) {
  if (!ego.pose) return {};
  const VehicleShape shape = ego.shape.value_or(VehicleShape{});
  const double length = shape.wheelbase + shape.front_overhang + shape.rear_overhang;
  const double ahead = 0.5 * length - shape.rear_overhang;
  const auto pose = ego.pose;
  return {{[pose, ahead](double t) {
             const Eigen::Vector3d axle = pose(t);
             return Eigen::Vector3d(axle.x() + ahead * std::cos(axle.z()),
                                    axle.y() + ahead * std::sin(axle.z()), axle.z());
           },
           0.5 * length, 0.5 * shape.width}};
}

MovingBox boxOf(const std::shared_ptr<const Motion>& motion, const Eigen::Vector2d& half) {
  return {[motion](double t) { return motion->pose(t); }, half.x(), half.y()};
}

/// Finds ways for one agent after the other and remembers where the ones before are.
class Planner {
 public:
  Planner(const Garage& garage, const EgoInput& ego)
      : garage_(garage),
        ego_(ego),
        duration_(ego.duration > 0.0 ? ego.duration : kDefaultDuration),
        boxes_(egoBoxes(ego)) {}

  [[nodiscard]] double duration() const { return duration_; }

  std::shared_ptr<const Motion> car(const Eigen::Vector2d& half, double middle, Random& random) {
    return best(half, 18.0, [&](int) -> std::optional<std::pair<AgentTrack, AgentLimits>> {
      AgentLimits limits;
      limits.top_speed = random.integer(4, 6);
      limits.start_after = random.uniform(0.0, 4.0);
      std::optional<AgentTrack> track =
          carTrack(garage_, middle, 0.5 * limits.top_speed * duration_, random);
      if (!track) return std::nullopt;
      return std::pair(std::move(*track), limits);
    });
  }

  std::shared_ptr<const Motion> person(const Eigen::Vector2d& half, Random& random) {
    return best(half, 9.0, [&](int candidate) -> std::optional<std::pair<AgentTrack, AgentLimits>> {
      AgentLimits limits;
      limits.top_speed = random.integer(2, 3);
      limits.speed_up = 2;
      limits.start_after = random.uniform(0.0, 0.5 * duration_);
      std::optional<Eigen::Vector2d> near;
      if (ego_.pose && candidate > 0) {
        // Cross where the own car comes by a little later.
        const double t = random.uniform(4.0, std::max(5.0, duration_ - 3.0));
        near = ego_.pose(t).head<2>();
        limits.start_after = std::max(0.0, t - random.uniform(6.0, 14.0));
      }
      std::optional<AgentTrack> track = personTrack(garage_, near, random);
      if (!track) return std::nullopt;
      return std::pair(std::move(*track), limits);
    });
  }

 private:
  template <class MakeCandidate>
  std::shared_ptr<const Motion> best(const Eigen::Vector2d& half, double near,
                                     const MakeCandidate& make) {
    std::shared_ptr<const Motion> chosen;
    double most = -1.0;
    for (int candidate = 0; candidate < kCandidates; ++candidate) {
      auto proposal = make(candidate);
      if (!proposal || hitsStanding(proposal->first, half, garage_)) continue;
      std::optional<AgentSchedule> schedule =
          planSchedule(proposal->first, half, boxes_, proposal->second, duration_);
      if (!schedule) continue;
      auto motion =
          std::make_shared<const Motion>(Motion{std::move(proposal->first), std::move(*schedule)});
      const double seconds = timeInView(*motion, ego_, duration_, near);
      if (seconds > most) {
        most = seconds;
        chosen = motion;
      }
    }
    if (chosen) boxes_.push_back(boxOf(chosen, half));
    return chosen;
  }

  const Garage& garage_;
  const EgoInput& ego_;
  double duration_;
  std::vector<MovingBox> boxes_;
};

PersonLook drawLook(Random& random) {
  PersonLook look;
  look.height = std::clamp(random.normal(1.70, 0.09), 1.48, 1.95);
  look.girth = random.uniform(0.85, 1.25);
  const auto cloth = [&](double brightest) {
    const double grey = random.uniform(0.015, brightest);
    const double hue = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double strength = random.uniform(0.0, 0.8);
    Eigen::Vector3f colour;
    for (int c = 0; c < 3; ++c) {
      colour[c] = static_cast<float>(grey * (1.0 + strength * std::cos(hue + 2.1 * c)));
    }
    return colour;
  };
  look.top = cloth(0.5);
  look.trousers = cloth(0.15);
  look.shoes = cloth(0.1);
  const auto tone = static_cast<float>(random.uniform(0.25, 1.3));
  look.skin = tone * Eigen::Vector3f(0.40F, 0.24F, 0.17F);
  look.hair = cloth(0.06);
  look.skirt_coat = random.chance(0.3);
  return look;
}

SE3 uprightPose(const Garage& garage, const Eigen::Vector3d& pose) {
  const Eigen::Vector2d p = pose.head<2>();
  return {SO3::fromYawPitchRoll(pose.z(), 0.0, 0.0), {p.x(), p.y(), garage.floorHeight(p)}};
}

}  // namespace

void addAgents(const Garage& garage, int vehicles, int pedestrians, const EgoInput& ego,
               const CarMaterials& materials, const Random& random, Scene& scene) {
  Planner planner(garage, ego);
  // Poses are asked for long after the caller's garage may be gone.
  const auto ground = std::make_shared<const Garage>(garage);
  std::uint32_t instance = kAgentInstance;
  for (int i = 0; i < vehicles; ++i) {
    Random draws = random.fork("car", static_cast<std::uint64_t>(i));
    const CarBody body = drawCarBody(draws);
    const CarSize size = typicalSize(body);
    const Eigen::Vector2d half(0.5 * size.length, 0.5 * size.width);
    // The rear axle stands about a fifth of the length before the rear end.
    const auto motion = planner.car(half, 0.29 * size.length, draws);
    const CarPaint paint = drawCarPaint(draws);
    if (!motion) continue;
    CarMaterials own = materials;
    own.paint = addCarPaint(scene, paint.colour, paint.metallic);
    const int mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(makeCarMesh(body, size, own));
    MovingObject object;
    object.instance = instance++;
    object.label = SemanticClass::kVehicle;
    object.box_size = {size.length, size.width, size.height};
    object.pose = [ground, motion](double t) {
      const Eigen::Vector3d pose = motion->pose(t);
      return poseOnFloor(*ground, pose.head<2>(), pose.z());
    };
    object.mesh = [mesh](double) { return mesh; };
    object.head_lamps = true;
    scene.moving.push_back(std::move(object));
  }
  for (int i = 0; i < pedestrians; ++i) {
    Random draws = random.fork("person", static_cast<std::uint64_t>(i));
    const PersonLook look = drawLook(draws);
    const Eigen::Vector2d half(0.35, 0.28);
    const auto motion = planner.person(half, draws);
    if (!motion) continue;
    const std::vector<int> meshes = addPersonMeshes(scene, look);
    const double cycle = gaitCycleLength(look.height);
    MovingObject object;
    object.instance = instance++;
    object.label = SemanticClass::kPedestrian;
    object.box_size = {0.6, 0.5, look.height};
    object.pose = [ground, motion](double t) { return uprightPose(*ground, motion->pose(t)); };
    object.mesh = [meshes, motion, cycle](double t) {
      constexpr double kStanding = 0.1;  // m/s
      if (motion->schedule.speed(t) < kStanding) return meshes.back();
      const double phase = motion->schedule.distance(t) / cycle;
      return meshes[static_cast<std::size_t>(kGaitPhases * (phase - std::floor(phase))) %
                    kGaitPhases];
    };
    scene.moving.push_back(std::move(object));
  }
}

}  // namespace parkade::sim
