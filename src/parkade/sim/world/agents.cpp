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

#include "parkade/sim/drive/lane.hpp"
#include "parkade/sim/drive/path.hpp"
#include "parkade/sim/world/agent_motion.hpp"
#include "parkade/sim/world/aisle_graph.hpp"
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

AgentTrack trackOf(const Path& path, double middle) {
  AgentTrack track;
  const int count = static_cast<int>(path.length() / AgentTrack::kSpacing);
  for (int i = 0; i <= count; ++i) {
    const PathPoint axle = path.at(i * AgentTrack::kSpacing);
    track.poses.emplace_back(axle.position.x() + middle * std::cos(axle.heading),
                             axle.position.y() + middle * std::sin(axle.heading), axle.heading);
  }
  return track;
}

// A random walk on the aisles, as far as a car gets in the time, on the right-hand side.
std::optional<AgentTrack> carTrack(const Garage& garage, double middle, double length,
                                   Random& random) {
  const AisleGraph& graph = garage.aisles;
  std::vector<int> nodes = {static_cast<int>(random.index(graph.nodes.size()))};
  double total = 0.0;
  while (total < length && nodes.size() < 60) {
    std::vector<int> choices;
    for (const int next : neighboursOf(graph, nodes.back())) {
      if (nodes.size() < 2 || next != nodes[nodes.size() - 2]) choices.push_back(next);
    }
    if (choices.empty()) break;
    nodes.push_back(random.pick(choices));
    total += (graph.nodes[static_cast<std::size_t>(nodes.back())] -
              graph.nodes[static_cast<std::size_t>(nodes[nodes.size() - 2])])
                 .norm();
  }
  std::vector<LaneSegment> segments;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    LaneSegment segment;
    segment.from = graph.nodes[static_cast<std::size_t>(nodes[i])];
    segment.to = graph.nodes[static_cast<std::size_t>(nodes[i + 1])];
    for (const AisleGraph::Edge& edge : graph.edges) {
      if ((edge.from == nodes[i] && edge.to == nodes[i + 1]) ||
          (edge.to == nodes[i] && edge.from == nodes[i + 1])) {
        segment.width = edge.width;
        segment.one_way = edge.one_way;
      }
    }
    segments.push_back(segment);
  }
  if (segments.empty()) return std::nullopt;
  LaneOptions lane;
  lane.offset = 1.55;
  lane.right_turn_offset = 0.9;
  lane.wander = 0.05;
  PathLeg leg;
  leg.vertices = laneVertices(segments, lane, random);
  leg.corners.radius = 5.5;
  leg.corners.min_radius = 4.5;
  leg.corners.blend = 2.5;
  const Result<Path> path = buildPath({leg});
  if (!path || path->length() < 5.0) return std::nullopt;
  return trackOf(*path, middle);
}

// Rounds a polyline by averaging over a walked metre, and turns it into a track.
AgentTrack walkingTrack(const std::vector<Eigen::Vector2d>& corners) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d step = corners[i + 1] - corners[i];
    const int count = std::max(1, static_cast<int>(step.norm() / AgentTrack::kSpacing));
    for (int k = 0; k < count; ++k) points.emplace_back(corners[i] + k * step / count);
  }
  points.push_back(corners.back());
  constexpr int kHalfWindow = 5;
  const int last = static_cast<int>(points.size()) - 1;
  std::vector<Eigen::Vector2d> smooth;
  for (int i = 0; i <= last; ++i) {
    // A window that shrinks towards the ends keeps them where they are.
    const int half = std::min({kHalfWindow, i, last - i});
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int k = -half; k <= half; ++k) sum += points[static_cast<std::size_t>(i + k)];
    smooth.emplace_back(sum / (2.0 * half + 1.0));
  }
  AgentTrack track;
  double yaw = 0.0;
  for (int i = 0; i <= last; ++i) {
    const Eigen::Vector2d along = smooth[static_cast<std::size_t>(std::min(i + 2, last))] -
                                  smooth[static_cast<std::size_t>(std::max(i - 2, 0))];
    const double heading = std::atan2(along.y(), along.x());
    yaw = i == 0 ? heading : yaw + wrapAngle(heading - yaw);
    const Eigen::Vector2d& p = smooth[static_cast<std::size_t>(i)];
    track.poses.emplace_back(p.x(), p.y(), yaw);
  }
  return track;
}

// Along one side of an aisle, across it, and along the other side. Near a place, if one is given.
std::optional<AgentTrack> personTrack(const Garage& garage,
                                      const std::optional<Eigen::Vector2d>& near, Random& random) {
  const AisleGraph& graph = garage.aisles;
  if (graph.edges.empty()) return std::nullopt;
  const AisleGraph::Edge* edge = &random.pick(graph.edges);
  double share = random.uniform(0.25, 0.75);
  const auto node = [&](int i) -> const Eigen::Vector2d& {
    return graph.nodes[static_cast<std::size_t>(i)];
  };
  if (near) {
    double best = std::numeric_limits<double>::max();
    for (const AisleGraph::Edge& one : graph.edges) {
      const Eigen::Vector2d along = node(one.to) - node(one.from);
      const double u =
          std::clamp((*near - node(one.from)).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double distance = (node(one.from) + u * along - *near).norm();
      if (distance < best) {
        best = distance;
        edge = &one;
        share = std::clamp(u, 0.1, 0.9);
      }
    }
  }
  const Eigen::Vector2d a = node(edge->from);
  const Eigen::Vector2d b = node(edge->to);
  const double length = (b - a).norm();
  if (length < 12.0) return std::nullopt;
  Eigen::Vector2d along = (b - a) / length;
  if (random.chance(0.5)) along = -along;
  const Eigen::Vector2d left(-along.y(), along.x());
  const double side = (random.chance(0.5) ? 1.0 : -1.0) * (0.5 * edge->width - 0.45);
  const Eigen::Vector2d crossing = a + share * (b - a);
  // Stay clear of the crossings of aisles at both ends.
  const auto room = [&](const Eigen::Vector2d& direction) {
    return std::max(
        1.0, (direction.dot(b - a) > 0.0 ? (b - crossing).norm() : (crossing - a).norm()) - 4.0);
  };
  const double before = std::min(random.uniform(2.0, 14.0), room(-along));
  const double after = std::min(random.uniform(3.0, 25.0), room(along));
  return walkingTrack({crossing - before * along + side * left, crossing + side * left,
                       crossing - side * left + 0.6 * along,
                       crossing - side * left + after * along});
}

// Whether a track runs through a pillar, a room or a parked car.
bool hitsStanding(const AgentTrack& track, const Eigen::Vector2d& half, const Garage& garage) {
  constexpr double kClear = 0.15;
  for (std::size_t i = 0; i < track.poses.size(); i += 2) {
    const Eigen::Vector3d& pose = track.poses[i];
    const auto touches = [&](const Eigen::Vector2d& center, const Eigen::Vector2d& other,
                             double yaw) {
      const Eigen::Vector3d box(center.x(), center.y(), yaw);
      const double far = half.norm() + other.norm() + kClear;
      return (center - pose.head<2>()).squaredNorm() < far * far &&
             boxDistance(pose, half, box, other) < kClear;
    };
    for (const Pillar& pillar : garage.pillars) {
      if (touches(pillar.center, 0.5 * pillar.size, 0.0)) return true;
    }
    for (const Room& room : garage.rooms) {
      if (touches(0.5 * (room.min + room.max), 0.5 * (room.max - room.min), 0.0)) return true;
    }
    for (const Slot& slot : garage.slots) {
      if (!slot.occupied) continue;
      const Eigen::Vector2d axis = slot.corners[3] - slot.corners[0];
      const Eigen::Vector2d center =
          0.25 * (slot.corners[0] + slot.corners[1] + slot.corners[2] + slot.corners[3]);
      if (touches(center, {0.5 * axis.norm() - 0.1, 0.95}, std::atan2(axis.y(), axis.x())))
        return true;
    }
  }
  return false;
}

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
