// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/object_agents.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/geometry/planar.hpp"
#include "parkade/semantics/markings/marking_objects.hpp"
#include "parkade/semantics/standing/car_parting.hpp"

namespace parkade {
namespace {

using Points = std::vector<Eigen::Vector2d>;

// Range at a step to the side of a swept point; 0 where the sweep ends before.
double rangeBeside(const Points& swept, const std::vector<double>& ranges,
                   const Eigen::Vector2d& viewer, std::size_t at, int way) {
  constexpr double kBeside = 0.4;  // m
  const Eigen::Vector2d ray = (swept[at] - viewer).normalized();
  for (auto i = static_cast<std::ptrdiff_t>(at) + way;
       i >= 0 && i < static_cast<std::ptrdiff_t>(swept.size()); i += way) {
    const auto k = static_cast<std::size_t>(i);
    if (std::abs(cross(ray, swept[k] - swept[at])) > kBeside) return ranges[k];
  }
  return 0.0;
}

// A car's points on the floor. Wheels stand out of its edge towards the viewer like teeth; the rest
// is the body's lower edge, seen over the floor behind.
Points onFloor(const Points& swept, const BevViews& views, const BevGeometry& geometry,
               double clearance) {
  constexpr double kTooth = 1.1;  // how much farther away the body is seen beside a wheel
  constexpr double kNoBulge = 1.04;
  std::vector<double> ranges;
  for (const Eigen::Vector2d& p : swept) {
    ranges.push_back((p - views.viewAt(geometry, p).foot).norm());
  }
  std::vector<std::size_t> wheels;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    const double left = rangeBeside(swept, ranges, geometry.center, i, 1);
    const double right = rangeBeside(swept, ranges, geometry.center, i, -1);
    const double most = std::max(left, right);
    const double least = left > 0.0 && right > 0.0 ? std::min(left, right) : most;
    if (most > kTooth * ranges[i] && least > kNoBulge * ranges[i]) wheels.push_back(i);
  }
  Points out;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    const BevViews::View& view = views.viewAt(geometry, swept[i]);
    const double nearer = clearance / std::max(view.height, 2.0 * clearance);
    double range = (1.0 - nearer) * ranges[i];
    // A body does not reach far beyond the wheels beside.
    constexpr double kBeside = 0.8;   // m
    constexpr double kBeyond = 0.15;  // m
    for (const std::size_t k : wheels) {
      if ((swept[k] - swept[i]).norm() < kBeside + ranges[i] - ranges[k]) {
        range = std::max(range, std::min(ranges[i], ranges[k] - kBeyond));
      }
    }
    out.push_back(view.foot + range / std::max(1e-6, ranges[i]) * (swept[i] - view.foot));
  }
  return out;
}

AgentDetection vehicleOf(const CarEdge& car, const ContactEdge& edge, const BevLabels& labels,
                         const BevViews& views, double attitude_sigma,
                         const AgentOptions& options) {
  const BevViews::View& view = views.viewAt(labels.geometry, car.swept[car.swept.size() / 2]);
  const Points& points = car.floor;
  AgentDetection agent;
  agent.semantic_class = SemanticClass::kVehicle;
  agent.viewer = view.foot;
  agent.box = fitFaces(points, view.foot, nullptr, car.heading);
  const Eigen::Vector2d& middle = labels.geometry.center;
  agent.contact =
      *std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
        return (a - middle).squaredNorm() < (b - middle).squaredNorm();
      });
  const Eigen::Vector2d ray = agent.contact - view.foot;
  agent.covariance =
      groundCovariance(views, labels.geometry, agent.contact,
                       options.sigma_px * labels.geometry.metres_per_px, attitude_sigma)
          .topLeftCorner<2, 2>();
  // The clearance is known to half of it.
  const double share = 0.5 * options.body_clearance_m / view.height;
  agent.covariance += share * share * ray * ray.transpose();
  agent.cut = edge.cut;
  agent.confidence = edge.confidence;
  return agent;
}

void findVehicles(const ContactFinder& finder, const BevLabels& labels,
                  const std::vector<SlotObservation>& slots, const BevViews& views,
                  double attitude_sigma, const AgentOptions& options,
                  std::vector<AgentDetection>& out) {
  constexpr double kLeastEdge = 0.25;  // m
  const Eigen::Vector2d& middle = labels.geometry.center;
  for (const ContactEdge& edge : finder.find(labels, SemanticClass::kVehicle, 0.0,
                                             options.min_confidence, options.min_pixels)) {
    const auto floor = [&](const Points& swept) {
      return onFloor(swept, views, labels.geometry, options.body_clearance_m);
    };
    for (const CarEdge& car :
         partCars(sweepOver(edge.points, middle), middle, options.notch_m, slots, floor)) {
      if (reachOf(car.swept, 0, car.swept.size()) < kLeastEdge) continue;
      out.push_back(vehicleOf(car, edge, labels, views, attitude_sigma, options));
    }
  }
}

// Share of places somewhat behind an edge that go on showing a person, as what stands upright does;
// those beyond the picture do not count.
double smearedShare(const Points& edge, const BevLabels& labels, const Eigen::Vector2d& foot) {
  int seen = 0;
  int smeared = 0;
  for (const Eigen::Vector2d& p : edge) {
    const Eigen::Vector2d ray = (p - foot).normalized();
    for (const double behind : {0.4, 0.6, 0.8}) {
      const Eigen::Vector2d pixel = labels.geometry.toPixel(p + behind * ray);
      const auto u = static_cast<int>(std::lround(pixel.x()));
      const auto v = static_cast<int>(std::lround(pixel.y()));
      if (u < 0 || v < 0 || u >= labels.labels.cols || v >= labels.labels.rows) continue;
      const auto label = static_cast<SemanticClass>(labels.labels.at<std::uint8_t>(v, u));
      ++seen;
      smeared += label == SemanticClass::kPedestrian ? 1 : 0;
    }
  }
  return seen > 0 ? static_cast<double>(smeared) / seen : 1.0;
}

void findPeople(const ContactFinder& finder, const BevLabels& labels, const BevViews& views,
                double attitude_sigma, const AgentOptions& options,
                std::vector<AgentDetection>& out) {
  constexpr double kGap = 0.3;      // m
  constexpr double kStride = 0.45;  // m: the other foot is this much farther away at most
  for (const ContactEdge& edge : finder.find(labels, SemanticClass::kPedestrian, kGap,
                                             options.min_confidence, options.min_pixels)) {
    const BevViews::View& view = views.views[static_cast<std::size_t>(edge.view)];
    double nearest = 1e9;
    for (const Eigen::Vector2d& p : edge.points)
      nearest = std::min(nearest, (p - view.foot).norm());
    // Hands and coats hang over the floor and are seen far behind the feet.
    Points feet;
    for (const Eigen::Vector2d& p : edge.points) {
      if ((p - view.foot).norm() < 1.1 * nearest + kStride) feet.push_back(p);
    }
    // Specks that a network sees by mistake are neither sure nor long.
    constexpr double kSure = 0.6;
    constexpr double kSmeared = 0.1;
    if (edge.confidence < kSure && smearedShare(feet, labels, view.foot) < kSmeared) continue;
    Eigen::Vector2d low = feet.front();
    Eigen::Vector2d high = feet.front();
    for (const Eigen::Vector2d& p : feet) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    AgentDetection agent;
    agent.semantic_class = SemanticClass::kPedestrian;
    agent.contact = 0.5 * (low + high);
    agent.viewer = view.foot;
    agent.box.center = agent.contact;
    agent.box.size = Eigen::Vector2d(0.5, 0.5);
    constexpr double kFeet = 0.12;  // m: the body is over them to this
    agent.covariance =
        groundCovariance(views, labels.geometry, agent.contact,
                         std::hypot(kFeet, options.sigma_px * labels.geometry.metres_per_px),
                         attitude_sigma)
            .topLeftCorner<2, 2>();
    agent.cut = edge.cut;
    agent.confidence = edge.confidence;
    out.push_back(agent);
  }
}

bool isBehind(const Eigen::Vector2d& what, const Eigen::Vector2d& other,
              const Eigen::Vector2d& viewer) {
  constexpr double kBeside = 0.35;  // m
  const Eigen::Vector2d a = what - viewer;
  const Eigen::Vector2d b = other - viewer;
  return b.norm() < a.norm() && b.dot(a) > 0.0 && std::abs(cross(b, a)) < kBeside * a.norm();
}

// A person's limbs over the floor may look like more people behind, and so does the smear away from
// the camera that sees the person best, where the picture goes over to another camera's.
void dropEchoes(const BevViews& views, const BevGeometry& geometry,
                std::vector<AgentDetection>& agents) {
  std::vector<AgentDetection> kept;
  for (std::size_t i = 0; i < agents.size(); ++i) {
    const AgentDetection& a = agents[i];
    bool echo = false;
    for (std::size_t j = 0; j < agents.size() && !echo; ++j) {
      const AgentDetection& b = agents[j];
      if (j == i || a.semantic_class != b.semantic_class) continue;
      if (a.semantic_class != SemanticClass::kPedestrian) continue;
      echo = isBehind(a.contact, b.contact, views.viewAt(geometry, a.contact).foot) ||
             isBehind(a.contact, b.contact, views.viewAt(geometry, b.contact).foot);
    }
    if (!echo) kept.push_back(a);
  }
  agents = std::move(kept);
}

}  // namespace

std::vector<AgentDetection> findAgents(const ContactFinder& finder, const BevLabels& labels,
                                       const std::vector<SlotObservation>& slots,
                                       const BevViews& views, double attitude_sigma,
                                       const AgentOptions& options) {
  std::vector<AgentDetection> agents;
  findVehicles(finder, labels, slots, views, attitude_sigma, options, agents);
  findPeople(finder, labels, views, attitude_sigma, options, agents);
  dropEchoes(views, labels.geometry, agents);
  return agents;
}

}  // namespace parkade
