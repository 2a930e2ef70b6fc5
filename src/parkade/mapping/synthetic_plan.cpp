// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/synthetic_plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace parkade::testing {
namespace {

using Eigen::Vector2d;

constexpr double kSlotWidth = 2.5;
constexpr double kSlotDepth = 5.0;
constexpr double kHalfAisle = 3.0;
constexpr double kAislePitch = 16.0;
constexpr double kCameraHeight = 1.0;

void addRow(Plan& plan, double x0, int count, double y_entrance, double y_rear, double occupancy,
            Random& random) {
  // side: rows above the aisle are entered northwards, the others southwards.
  const bool north = y_rear > y_entrance;
  plan.lines.push_back({{x0, y_entrance}, {x0 + count * kSlotWidth, y_entrance}});
  for (int i = 0; i <= count; ++i) {
    const double x = x0 + i * kSlotWidth;
    plan.lines.push_back({{x, y_entrance}, {x, y_rear}});
    if (i == count) break;
    PlanSlot slot;
    const Vector2d left(x, y_entrance);
    const Vector2d right(x + kSlotWidth, y_entrance);
    const Vector2d far_left(x, y_rear);
    const Vector2d far_right(x + kSlotWidth, y_rear);
    slot.corners = north ? std::array<Vector2d, 4>{left, right, far_right, far_left}
                         : std::array<Vector2d, 4>{right, left, far_left, far_right};
    slot.occupied = random.chance(occupancy);
    slot.number = std::to_string(plan.slots.size() + 1);
    plan.slots.push_back(slot);
  }
}

}  // namespace

Plan makePlan(int aisles, double length, double occupancy, std::uint64_t seed) {
  Random random(seed);
  Plan plan;
  const int count = static_cast<int>((length - 8.0) / kSlotWidth);
  const double x0 = 0.5 * (length - count * kSlotWidth);
  plan.min = {-10.0, -kHalfAisle - kSlotDepth - 1.0};
  plan.max = {length + 10.0, kAislePitch * (aisles - 1) + kHalfAisle + kSlotDepth + 1.0};
  for (int k = 0; k < aisles; ++k) {
    const double y = kAislePitch * k;
    addRow(plan, x0, count, y + kHalfAisle, y + kHalfAisle + kSlotDepth, occupancy, random);
    addRow(plan, x0, count, y - kHalfAisle, y - kHalfAisle - kSlotDepth, occupancy, random);
    for (double x = 6.0; x < length; x += 12.0) {
      plan.objects.push_back({SemanticClass::kArrow,
                              {x + random.uniform(-1.0, 1.0), y - 1.2, 0.0},
                              k % 2 == 0 ? 0.0 : M_PI,
                              random.chance(0.5) ? "straight" : "straight_left",
                              {2.0, 0.5}});
    }
    for (int i = 0; i * 3 <= count; ++i) {
      // A pillar on every third line, set back from the aisle, with its zone's text.
      const Vector2d at(x0 + 3.0 * i * kSlotWidth, y + kHalfAisle + 1.0);
      plan.objects.push_back({SemanticClass::kPillar, {at.x(), at.y(), 0.0}, 0.0, "", {0.4, 0.4}});
      const std::string text = fmt::format("{}{}", static_cast<char>('A' + k), i / 2 + 1);
      plan.objects.push_back(
          {SemanticClass::kZoneMarker, {at.x(), at.y() - 0.21, 1.6}, -M_PI / 2, text, {0.0, 0.0}});
    }
  }
  return plan;
}

std::vector<SE2> blockDrive(double length, int laps, double step) {
  constexpr double kRadius = 5.0;
  const double straight_x = length - 2.0 * kRadius + 8.0;
  const double straight_y = kAislePitch - 2.0 * kRadius;
  std::vector<SE2> poses;
  SE2 pose(0.0, {length / 2, 0.0});
  double carry = 0.0;
  const auto go = [&](double distance, double curvature) {
    double at = carry;
    for (; at < distance; at += step) {
      poses.push_back(pose * SE2::exp({at, 0.0, at * curvature}));
    }
    carry = at - distance;
    pose = pose * SE2::exp({distance, 0.0, distance * curvature});
  };
  for (int lap = 0; lap < laps; ++lap) {
    go(0.5 * straight_x, 0.0);
    for (const double side : {straight_y, straight_x, straight_y}) {
      go(kRadius * M_PI / 2, 1.0 / kRadius);
      go(side, 0.0);
    }
    go(kRadius * M_PI / 2, 1.0 / kRadius);
    go(0.5 * straight_x, 0.0);
  }
  return poses;
}

ObserverNoise usualNoise() {
  ObserverNoise noise;
  noise.line_sigma = 0.015;
  noise.corner_sigma = 0.03;
  noise.object_sigma = 0.05;
  noise.attitude_sigma = 0.001;
  noise.dropout = 0.2;
  return noise;
}

// The straight line through noisy points of one painted line.
void addSegment(const std::vector<Vector2d>& points, const PlanLine& line, double sigma,
                std::vector<LineSegment>& segments) {
  if (points.size() < 5) return;
  const Vector2d chord = points.back() - points.front();
  const double length = chord.norm();
  if (length < 0.5) return;
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& p : points) mean += p / static_cast<double>(points.size());
  // Offset across the chord, as a linear function along it.
  const Vector2d along = chord / length;
  const Vector2d across(-along.y(), along.x());
  double xx = 0.0;
  double xy = 0.0;
  for (const Vector2d& p : points) {
    const double x = along.dot(p - mean);
    xx += x * x;
    xy += x * across.dot(p - mean);
  }
  const Vector2d direction = (along + across * (xy / xx)).normalized();
  LineSegment segment;
  segment.begin = mean - 0.5 * length * direction;
  segment.end = mean + 0.5 * length * direction;
  segment.width = line.width;
  segment.sigma_heading = std::max(1e-4, sigma) / std::sqrt(xx);
  segment.sigma_offset = std::max(1e-3, sigma) / std::sqrt(static_cast<double>(points.size()));
  segment.semantic_class = line.semantic_class;
  segments.push_back(segment);
}

PlanObserver::PlanObserver(const Plan& plan, const ObserverNoise& noise)
    : plan_(plan), noise_(noise) {
  rasterise();
}

void PlanObserver::rasterise() {
  const Vector2d size = plan_.max - plan_.min;
  width_ = static_cast<int>(std::ceil(size.x() / cell_));
  const int height = static_cast<int>(std::ceil(size.y() / cell_));
  raster_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height),
                 static_cast<std::uint8_t>(SemanticClass::kFloor));
  const auto paint = [&](const Vector2d& center, double heading, const Vector2d& box,
                         SemanticClass c) {
    const SE2 T_plan_box(heading, center);
    const SE2 T_box_plan = T_plan_box.inverse();
    const Vector2d reach = 0.5 * T_plan_box.rotationMatrix().cwiseAbs() * box;
    const Vector2d low = (center - reach - plan_.min) / cell_ - Vector2d::Ones();
    const Vector2d high = (center + reach - plan_.min) / cell_ + Vector2d::Ones();
    for (int y = std::max(0, static_cast<int>(low.y()));
         y < std::min(height, static_cast<int>(high.y()) + 1); ++y) {
      for (int x = std::max(0, static_cast<int>(low.x()));
           x < std::min(width_, static_cast<int>(high.x()) + 1); ++x) {
        const Vector2d p = plan_.min + cell_ * Vector2d(x + 0.5, y + 0.5);
        const Vector2d q = T_box_plan * p;
        if (std::abs(q.x()) > 0.5 * box.x() || std::abs(q.y()) > 0.5 * box.y()) continue;
        raster_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(c);
      }
    }
  };
  for (const PlanLine& line : plan_.lines) {
    const Vector2d along = line.b - line.a;
    paint(0.5 * (line.a + line.b), std::atan2(along.y(), along.x()),
          {along.norm() + line.width, line.width}, line.semantic_class);
  }
  for (const PlanObject& object : plan_.objects) {
    if (object.size.x() > 0.0) {
      paint(object.position.head<2>(), object.heading, object.size, object.semantic_class);
    }
  }
  for (const PlanSlot& slot : plan_.slots) {
    if (!slot.occupied) continue;
    const Vector2d entrance = 0.5 * (slot.corners[0] + slot.corners[1]);
    const Vector2d rear = 0.5 * (slot.corners[2] + slot.corners[3]);
    const Vector2d along = rear - entrance;
    paint(0.5 * (entrance + rear), std::atan2(along.y(), along.x()), {4.4, 1.8},
          SemanticClass::kVehicle);
  }
}

SemanticClass PlanObserver::classAt(const Vector2d& p) const {
  for (const PlanMover& mover : plan_.movers) {
    if (insideBox(p, mover.position, mover.heading, mover.size)) return SemanticClass::kVehicle;
  }
  if (p.x() <= plan_.min.x() || p.y() <= plan_.min.y() || p.x() >= plan_.max.x() ||
      p.y() >= plan_.max.y()) {
    return SemanticClass::kUnknown;
  }
  const Vector2d q = (p - plan_.min) / cell_;
  const std::size_t at = static_cast<std::size_t>(q.y()) * static_cast<std::size_t>(width_) +
                         static_cast<std::size_t>(std::min(width_ - 1, static_cast<int>(q.x())));
  return at < raster_.size() ? static_cast<SemanticClass>(raster_[at]) : SemanticClass::kUnknown;
}

SemanticFrame PlanObserver::observe(TimeNs t_ns, const SE2& T_world_vehicle, Random& random,
                                    bool draw_labels) const {
  const SE2 T_vehicle_world = T_world_vehicle.inverse();
  SemanticFrame frame;
  frame.labels.t_ns = t_ns;
  frame.labels.geometry.center = {1.4, 0.0};
  frame.attitude_sigma = noise_.attitude_sigma;
  const double pitch = noise_.attitude_sigma * random.normal();
  const double roll = noise_.attitude_sigma * random.normal();
  // IPM with a wrong attitude puts ground where its ray meets a tilted plane.
  const auto distort = [&](const Vector2d& p) -> Vector2d {
    const Vector2d from_camera = p - frame.labels.geometry.center;
    const double rise = -pitch * p.x() + roll * p.y();
    return p + rise / kCameraHeight * from_camera;
  };
  const auto tiltCovariance = [&](const Vector2d& p) -> Eigen::Matrix2d {
    const Vector2d ray = p - frame.labels.geometry.center;
    const double rise = noise_.attitude_sigma * p.norm() / kCameraHeight;
    return rise * rise * ray * ray.transpose();
  };
  const auto seen = [&](const Vector2d& p_world) {
    return (T_vehicle_world * p_world - frame.labels.geometry.center).norm() < noise_.range_m;
  };
  for (const PlanLine& line : plan_.lines) {
    const Vector2d along = (line.b - line.a).normalized();
    const Vector2d normal(-along.y(), along.x());
    const double length = (line.b - line.a).norm();
    if (!seen(line.a +
              along * std::clamp(along.dot(T_world_vehicle * frame.labels.geometry.center - line.a),
                                 0.0, length)))
      continue;
    std::vector<Vector2d> run;  // of points without outliers, for the segment
    constexpr double kSpacing = 0.15;
    for (double s = random.uniform(0.0, kSpacing); s < length; s += kSpacing) {
      const Vector2d p_world = line.a + s * along;
      if (!seen(p_world) || random.chance(noise_.dropout)) continue;
      if (classAt(p_world) != line.semantic_class) continue;
      LinePoint point;
      point.p_level = distort(T_vehicle_world * p_world);
      point.normal = T_vehicle_world.rotationMatrix() * normal;
      point.p_level += noise_.line_sigma * random.normal() * point.normal;
      const Vector2d ray = point.p_level - frame.labels.geometry.center;
      point.sigma = std::hypot(
          std::max(0.005, noise_.line_sigma),
          noise_.attitude_sigma * point.p_level.norm() / kCameraHeight * point.normal.dot(ray));
      point.semantic_class = line.semantic_class;
      run.push_back(point.p_level);
      if (random.chance(noise_.outliers)) {
        point.p_level += Vector2d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
      }
      frame.line_points.push_back(point);
    }
    addSegment(run, line, noise_.line_sigma, frame.line_segments);
  }
  for (const PlanSlot& slot : plan_.slots) {
    if (!seen(slot.corners[0]) || !seen(slot.corners[1]) || random.chance(noise_.dropout)) continue;
    SlotObservation o;
    for (std::size_t i = 0; i < 4; ++i) {
      o.corners[i] = distort(T_vehicle_world * slot.corners[i]) +
                     noise_.corner_sigma * Vector2d(random.normal(), random.normal());
    }
    const double sigma = std::max(0.01, noise_.corner_sigma);
    o.entrance_covariance = sigma * sigma * Eigen::Matrix4d::Identity();
    for (int i = 0; i < 2; ++i)
      o.entrance_covariance.block<2, 2>(2 * i, 2 * i) +=
          tiltCovariance(o.corners[static_cast<std::size_t>(i)]);
    o.rear_seen = seen(slot.corners[2]) && seen(slot.corners[3]);
    const bool free = random.chance(noise_.availability_error) ? slot.occupied : !slot.occupied;
    o.probability_free = free ? 0.9 : 0.1;
    o.confidence = 0.9;
    if (random.chance(0.3)) {
      o.number = {{slot.number, 0.9}};
      o.number_place = 0.25 * (o.corners[0] + o.corners[1] + o.corners[2] + o.corners[3]);
    }
    frame.slots.push_back(o);
  }
  for (const PlanObject& object : plan_.objects) {
    if (!seen(object.position.head<2>()) || random.chance(noise_.dropout)) continue;
    ObjectObservation o;
    o.semantic_class = object.semantic_class;
    o.position = object.position;
    o.position.head<2>() = distort(T_vehicle_world * object.position.head<2>());
    for (int i = 0; i < 3; ++i) o.position[i] += noise_.object_sigma * random.normal();
    const double sigma = std::max(0.02, noise_.object_sigma);
    o.covariance = sigma * sigma * Eigen::Matrix3d::Identity();
    o.covariance.topLeftCorner<2, 2>() += tiltCovariance(o.position.head<2>());
    o.heading = wrapAngle(object.heading - T_world_vehicle.angle());
    o.sigma_heading = object.semantic_class == SemanticClass::kPillar ? 0.0 : 0.05;
    o.text = object.text;
    o.confidence = 0.9;
    frame.objects.push_back(o);
  }
  for (const PlanMover& mover : plan_.movers) {
    if (!seen(mover.position)) continue;
    MovingObservation o;
    o.id = 1;
    o.contact = T_vehicle_world * mover.position;
    o.contact *= 1.0 - 0.5 * mover.size.y() / o.contact.norm();
    o.size = mover.size;
    o.heading = wrapAngle(mover.heading - T_world_vehicle.angle());
    o.moving = true;
    frame.moving.push_back(o);
  }
  if (!draw_labels) return frame;
  const BevGeometry& g = frame.labels.geometry;
  frame.labels.labels = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(0));
  frame.labels.confidence = cv::Mat(g.height_px, g.width_px, CV_8UC1, cv::Scalar(0));
  for (int v = 0; v < g.height_px; ++v) {
    for (int u = 0; u < g.width_px; ++u) {
      const Vector2d p = g.toGround({static_cast<double>(u), static_cast<double>(v)});
      if ((p - g.center).norm() > noise_.range_m) continue;
      const Vector2d true_p = 2.0 * p - distort(p);  // first-order inverse
      SemanticClass c = classAt(T_world_vehicle * true_p);
      if (c == SemanticClass::kUnknown) continue;
      if (random.chance(noise_.label_noise)) {
        c = static_cast<SemanticClass>(random.integer(1, 8));
      }
      frame.labels.labels.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(c);
      frame.labels.confidence.at<std::uint8_t>(v, u) = 230;
    }
  }
  return frame;
}

ParkingMap mapOf(const Plan& plan, const SE2& T_map_plan) {
  ParkingMap map;
  const PlanObserver observer(plan, {});
  const double step = 0.5 * map.grid.resolution();
  for (double y = plan.min.y(); y < plan.max.y(); y += step) {
    for (double x = plan.min.x(); x < plan.max.x(); x += step) {
      const Vector2d p(x, y);
      const SemanticClass c = observer.classAt(p);
      const bool line = c == SemanticClass::kSlotLine || c == SemanticClass::kLaneLine;
      constexpr float kSure = 2.0F;
      map.grid.add(GridLayer::kParkingLines, T_map_plan * p, line ? c : SemanticClass::kFloor,
                   kSure);
    }
  }
  std::int64_t id = 0;
  for (const PlanSlot& seen : plan.slots) {
    MapSlot slot;
    slot.id = ++id;
    for (std::size_t i = 0; i < 4; ++i) slot.corners[i] = T_map_plan * seen.corners[i];
    slot.corner_sigma = 0.01;
    slot.observations = 10;
    map.slots.push_back(slot);
  }
  for (const PlanObject& seen : plan.objects) {
    MapObject object;
    object.id = ++id;
    object.semantic_class = seen.semantic_class;
    object.position << T_map_plan * seen.position.head<2>(), seen.position.z();
    object.heading = wrapAngle(seen.heading + T_map_plan.angle());
    object.text = seen.text;
    object.position_sigma = 0.02;
    object.observations = 10;
    map.objects.push_back(object);
  }
  return map;
}

}  // namespace parkade::testing
