// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/agent_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade::sim {
namespace {

constexpr int kFinePerStep = 4;                                // checks within a step
constexpr double kFine = AgentSchedule::kStep / kFinePerStep;  // s
constexpr double kSpeedStep = 0.5;                             // m/s
// Between two checks both may move; half the way of the faster one is added to the clearance.
constexpr double kReserve = 0.3;  // m

// Distance from a point to a rectangle.
double pointDistance(const Eigen::Vector2d& p, const Eigen::Vector3d& box,
                     const Eigen::Vector2d& half) {
  const double c = std::cos(box.z());
  const double s = std::sin(box.z());
  const Eigen::Vector2d d = p - box.head<2>();
  const double x = std::max(0.0, std::abs(c * d.x() + s * d.y()) - half.x());
  const double y = std::max(0.0, std::abs(-s * d.x() + c * d.y()) - half.y());
  return std::hypot(x, y);
}

// Whether all corners of b lie beyond one side of a.
bool separated(const Eigen::Vector3d& a, const Eigen::Vector2d& half_a, const Eigen::Vector3d& b,
               const Eigen::Vector2d& half_b) {
  const Eigen::Vector2d d = b.head<2>() - a.head<2>();
  const double turn = b.z() - a.z();
  const double c = std::abs(std::cos(turn));
  const double s = std::abs(std::sin(turn));
  const double along = std::abs(std::cos(a.z()) * d.x() + std::sin(a.z()) * d.y());
  const double across = std::abs(-std::sin(a.z()) * d.x() + std::cos(a.z()) * d.y());
  return along > half_a.x() + c * half_b.x() + s * half_b.y() ||
         across > half_a.y() + s * half_b.x() + c * half_b.y();
}

// Bounds of the middles of so many places after one another. Boxes are mostly far from most of a
// track: one look at its bounds passes a block over.
constexpr std::size_t kBlockPlaces = 32;

std::vector<Eigen::AlignedBox2d> blockBounds(const AgentTrack& track) {
  std::vector<Eigen::AlignedBox2d> bounds((track.poses.size() + kBlockPlaces - 1) / kBlockPlaces);
  for (std::size_t k = 0; k < track.poses.size(); ++k) {
    bounds[k / kBlockPlaces].extend(track.poses[k].head<2>());
  }
  return bounds;
}

// Where and when a place of the track is too close to a box.
class BlockedMap {
 public:
  BlockedMap(const AgentTrack& track, const Eigen::Vector2d& half,
             const std::vector<MovingBox>& boxes, double clearance, double duration)
      : places_(static_cast<int>(track.poses.size())),
        times_(static_cast<int>(std::ceil(duration / kFine)) + 1),
        blocked_(static_cast<std::size_t>(places_) * static_cast<std::size_t>(times_), false) {
    const std::vector<Eigen::AlignedBox2d> bounds = blockBounds(track);
    const double reach = half.norm() + clearance + kReserve;
    for (int i = 0; i < times_; ++i) {
      for (const MovingBox& box : boxes) {
        const Eigen::Vector3d pose = box.pose(i * kFine);
        const Eigen::Vector2d middle = pose.head<2>();
        const Eigen::Vector2d other(box.half_length, box.half_width);
        const double far = reach + other.norm();
        for (std::size_t b = 0; b < bounds.size(); ++b) {
          if (bounds[b].squaredExteriorDistance(middle) > far * far) continue;
          const std::size_t end = std::min((b + 1) * kBlockPlaces, track.poses.size());
          for (std::size_t k = b * kBlockPlaces; k < end; ++k) {
            const Eigen::Vector3d& mine = track.poses[k];
            if ((mine.head<2>() - middle).squaredNorm() > far * far) continue;
            if (boxDistance(mine, half, pose, other) < clearance + kReserve) {
              blocked_[static_cast<std::size_t>(i) * static_cast<std::size_t>(places_) + k] = true;
            }
          }
        }
      }
    }
  }
  [[nodiscard]] bool at(int time, double s) const {
    const int k =
        std::clamp(static_cast<int>(std::lround(s / AgentTrack::kSpacing)), 0, places_ - 1);
    const int i = std::clamp(time, 0, times_ - 1);
    return blocked_[static_cast<std::size_t>(i) * static_cast<std::size_t>(places_) +
                    static_cast<std::size_t>(k)];
  }

 private:
  int places_;
  int times_;
  std::vector<bool> blocked_;
};

struct State {
  int place = 0;  // in track spacings
  int speed = 0;  // in speed steps
};

}  // namespace

double boxDistance(const Eigen::Vector3d& a, const Eigen::Vector2d& half_a,
                   const Eigen::Vector3d& b, const Eigen::Vector2d& half_b) {
  if (!separated(a, half_a, b, half_b) && !separated(b, half_b, a, half_a)) return 0.0;
  // Apart, the nearest points of two rectangles include a corner of one of them.
  double least = std::numeric_limits<double>::max();
  const auto corners = [&](const Eigen::Vector3d& box, const Eigen::Vector2d& half,
                           const Eigen::Vector3d& other, const Eigen::Vector2d& half_other) {
    const double c = std::cos(box.z());
    const double s = std::sin(box.z());
    for (const double x : {-half.x(), half.x()}) {
      for (const double y : {-half.y(), half.y()}) {
        const Eigen::Vector2d corner(box.x() + c * x - s * y, box.y() + s * x + c * y);
        least = std::min(least, pointDistance(corner, other, half_other));
      }
    }
  };
  corners(a, half_a, b, half_b);
  corners(b, half_b, a, half_a);
  return least;
}

Eigen::Vector3d AgentTrack::at(double s) const {
  const double place = std::clamp(s / kSpacing, 0.0, static_cast<double>(poses.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(place), poses.size() - 2);
  const double part = place - static_cast<double>(i);
  return poses[i] + part * (poses[i + 1] - poses[i]);
}

double AgentSchedule::distance(double t) const {
  const double steps = std::clamp(t / kStep, 0.0, static_cast<double>(s_.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(steps), s_.size() - 2);
  const double dt = kStep * (steps - static_cast<double>(i));
  return s_[i] + v_[i] * dt + 0.5 * (v_[i + 1] - v_[i]) / kStep * dt * dt;
}

double AgentSchedule::speed(double t) const {
  const double steps = std::clamp(t / kStep, 0.0, static_cast<double>(v_.size() - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(steps), v_.size() - 2);
  return v_[i] + (steps - static_cast<double>(i)) * (v_[i + 1] - v_[i]);
}

std::optional<AgentSchedule> planSchedule(const AgentTrack& track, const Eigen::Vector2d& half_size,
                                          const std::vector<MovingBox>& boxes,
                                          const AgentLimits& limits, double duration) {
  PARKADE_CHECK(track.poses.size() >= 2, "a track of {} places", track.poses.size());
  const BlockedMap blocked(track, half_size, boxes, limits.clearance, duration);
  const int steps = static_cast<int>(std::ceil(duration / AgentSchedule::kStep));
  const int last = static_cast<int>(track.poses.size()) - 1;
  const int speeds = limits.top_speed + 1;
  std::vector<bool> dead(static_cast<std::size_t>(steps + 1) * static_cast<std::size_t>(last + 1) *
                             static_cast<std::size_t>(speeds),
                         false);
  const auto index = [&](int step, const State& at) {
    return (static_cast<std::size_t>(step) * static_cast<std::size_t>(last + 1) +
            static_cast<std::size_t>(at.place)) *
               static_cast<std::size_t>(speeds) +
           static_cast<std::size_t>(at.speed);
  };
  // A step covers the mean of both speeds: 0.5 s * 0.25 m/s is one place per speed step.
  const auto next = [&](int step, const State& from, int speed) -> std::optional<State> {
    const State to{from.place + from.speed + speed, speed};
    if (to.place > last) return std::nullopt;
    for (int k = 1; k <= kFinePerStep; ++k) {
      const double t = kFine * k;
      const double v0 = kSpeedStep * from.speed;
      const double a = kSpeedStep * (speed - from.speed) / AgentSchedule::kStep;
      if (blocked.at(step * kFinePerStep + k,
                     from.place * AgentTrack::kSpacing + v0 * t + 0.5 * a * t * t)) {
        return std::nullopt;
      }
    }
    return dead[index(step + 1, to)] ? std::nullopt : std::optional(to);
  };
  if (blocked.at(0, 0.0)) return std::nullopt;
  std::vector<State> way = {State{}};
  while (static_cast<int>(way.size()) <= steps) {
    const State from = way.back();
    const int step = static_cast<int>(way.size()) - 1;
    const bool waits = step * AgentSchedule::kStep < limits.start_after;
    const int fastest = waits ? 0 : std::min(from.speed + limits.speed_up, limits.top_speed);
    std::optional<State> to;
    for (int v = fastest; !to && v >= std::max(0, from.speed - limits.slow_down); --v) {
      to = next(step, from, v);
    }
    if (to) {
      way.push_back(*to);
      continue;
    }
    dead[index(step, from)] = true;
    way.pop_back();
    if (way.empty()) return std::nullopt;
  }
  std::vector<double> s;
  std::vector<double> v;
  for (const State& state : way) {
    s.push_back(state.place * AgentTrack::kSpacing);
    v.push_back(state.speed * kSpeedStep);
  }
  if (s.size() < 2) return std::nullopt;
  return AgentSchedule(std::move(s), std::move(v));
}

}  // namespace parkade::sim
