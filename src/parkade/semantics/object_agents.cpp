// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/object_agents.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/geometry/planar.hpp"
#include "parkade/semantics/marking_objects.hpp"

namespace parkade {
namespace {

using Points = std::vector<Eigen::Vector2d>;

// Points in the order in which a viewer sweeps over them, with the nearest one of each direction.
Points sweep(const Points& points, const Eigen::Vector2d& viewer) {
  constexpr double kBin = M_PI / 360.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += (p - viewer) / static_cast<double>(points.size());
  const double middle = std::atan2(mean.y(), mean.x());
  std::vector<std::pair<int, std::size_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d d = points[i] - viewer;
    const double turn = std::remainder(std::atan2(d.y(), d.x()) - middle, 2.0 * M_PI);
    order.emplace_back(static_cast<int>(std::floor(turn / kBin)), i);
  }
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const double ra = (points[a.second] - viewer).squaredNorm();
    const double rb = (points[b.second] - viewer).squaredNorm();
    return ra != rb ? ra < rb : a.second < b.second;
  });
  Points out;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && order[k].first == order[k - 1].first) continue;
    out.push_back(points[order[k].second]);
  }
  return out;
}

// Indices of the points on the hull's side that faces the viewer, in sweeping order.
std::vector<std::size_t> nearHull(const Points& swept) {
  std::vector<std::size_t> hull;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    while (hull.size() >= 2) {
      const Eigen::Vector2d& a = swept[hull[hull.size() - 2]];
      const Eigen::Vector2d& b = swept[hull.back()];
      // Sweeping to the left, the near side turns to the right.
      if (cross(b - a, swept[i] - b) < 0.0) break;
      hull.pop_back();
    }
    hull.push_back(i);
  }
  return hull;
}

double extent(const Points& points, std::size_t begin, std::size_t end) {
  double reach = 0.0;
  for (std::size_t i = begin; i < end; ++i)
    reach = std::max(reach, (points[i] - points[begin]).norm());
  return reach;
}

// Where swept points part into two cars: after this index; 0 where they do not.
std::size_t findNotch(const Points& swept, double least_depth) {
  constexpr double kWidest = 1.1;    // m: gaps between cars; between a car's wheels it is wider
  constexpr double kCarWidth = 1.0;  // m: of a car's front at least so much is seen
  const std::vector<std::size_t> hull = nearHull(swept);
  std::size_t best = 0;
  double deepest = least_depth;
  for (std::size_t k = 0; k + 1 < hull.size(); ++k) {
    const Eigen::Vector2d& a = swept[hull[k]];
    const Eigen::Vector2d chord = swept[hull[k + 1]] - a;
    const double length = chord.norm();
    if (length < 0.2) continue;
    const auto depthOf = [&](std::size_t i) { return cross(swept[i] - a, chord) / length; };
    std::size_t at = 0;
    double depth = 0.0;
    for (std::size_t i = hull[k] + 1; i < hull[k + 1]; ++i) {
      const double d = std::abs(depthOf(i));
      if (d > depth) {
        depth = d;
        at = i;
      }
    }
    if (depth <= deepest) continue;
    // Its width half way down, along the chord.
    std::size_t left = at;
    std::size_t right = at;
    while (left > hull[k] && std::abs(depthOf(left)) > 0.5 * depth) --left;
    while (right < hull[k + 1] && std::abs(depthOf(right)) > 0.5 * depth) ++right;
    const double width = std::abs(chord.dot(swept[right] - swept[left])) / length;
    if (width > kWidest) continue;
    if (extent(swept, 0, at) < kCarWidth || extent(swept, at, swept.size()) < kCarWidth) continue;
    deepest = depth;
    best = at;
  }
  return best;
}

// After which point something else is in between, seen from the viewer; 0 where nothing is.
std::size_t findGap(const Points& swept, const Eigen::Vector2d& viewer) {
  constexpr double kGap = 0.5;  // m
  for (std::size_t i = 1; i < swept.size(); ++i) {
    const Eigen::Vector2d ray = (swept[i - 1] - viewer).normalized();
    if (std::abs(cross(ray, swept[i] - swept[i - 1])) > kGap) return i;
  }
  return 0;
}

void splitCars(Points swept, const Eigen::Vector2d& viewer, double least_depth,
               std::vector<Points>& out) {
  std::size_t at = findGap(swept, viewer);
  if (at == 0) at = findNotch(swept, least_depth);
  if (at == 0) {
    out.push_back(std::move(swept));
    return;
  }
  const auto middle = swept.begin() + static_cast<std::ptrdiff_t>(at);
  splitCars(Points(swept.begin(), middle), viewer, least_depth, out);
  splitCars(Points(middle, swept.end()), viewer, least_depth, out);
}

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

AgentDetection vehicleOf(const Points& swept, const ContactEdge& edge, const BevLabels& labels,
                         const BevViews& views, double attitude_sigma,
                         const AgentOptions& options) {
  const BevViews::View& view = views.viewAt(labels.geometry, swept[swept.size() / 2]);
  const Points points = onFloor(swept, views, labels.geometry, options.body_clearance_m);
  AgentDetection agent;
  agent.semantic_class = SemanticClass::kVehicle;
  agent.viewer = view.foot;
  agent.box = fitFaces(points, view.foot);
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

void findVehicles(const ContactFinder& finder, const BevLabels& labels, const BevViews& views,
                  double attitude_sigma, const AgentOptions& options,
                  std::vector<AgentDetection>& out) {
  constexpr double kLeastEdge = 0.25;  // m
  const Eigen::Vector2d& middle = labels.geometry.center;
  for (const ContactEdge& edge : finder.find(labels, SemanticClass::kVehicle, 0.0,
                                             options.min_confidence, options.min_pixels)) {
    std::vector<Points> cars;
    splitCars(sweep(edge.points, middle), middle, options.notch_m, cars);
    for (const Points& swept : cars) {
      if (extent(swept, 0, swept.size()) < kLeastEdge) continue;
      out.push_back(vehicleOf(swept, edge, labels, views, attitude_sigma, options));
    }
  }
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

// A person's limbs over the floor may look like more people behind.
void dropEchoes(const BevViews& views, const BevGeometry& geometry,
                std::vector<AgentDetection>& agents) {
  std::vector<AgentDetection> kept;
  for (std::size_t i = 0; i < agents.size(); ++i) {
    const AgentDetection& a = agents[i];
    const Eigen::Vector2d foot = views.viewAt(geometry, a.contact).foot;
    const double range = (a.contact - foot).norm();
    bool echo = false;
    for (std::size_t j = 0; j < agents.size() && !echo; ++j) {
      const AgentDetection& b = agents[j];
      if (j == i || a.semantic_class != b.semantic_class) continue;
      if (a.semantic_class != SemanticClass::kPedestrian) continue;
      const Eigen::Vector2d d = b.contact - foot;
      if (d.norm() >= range) continue;
      const double beside = std::abs(cross(d, a.contact - foot)) / range;
      echo = beside < 0.35 && d.dot(a.contact - foot) > 0.0;
    }
    if (!echo) kept.push_back(a);
  }
  agents = std::move(kept);
}

}  // namespace

std::vector<AgentDetection> findAgents(const ContactFinder& finder, const BevLabels& labels,
                                       const BevViews& views, double attitude_sigma,
                                       const AgentOptions& options) {
  std::vector<AgentDetection> agents;
  findVehicles(finder, labels, views, attitude_sigma, options, agents);
  findPeople(finder, labels, views, attitude_sigma, options, agents);
  dropEchoes(views, labels.geometry, agents);
  return agents;
}

}  // namespace parkade
