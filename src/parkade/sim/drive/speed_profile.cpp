// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/speed_profile.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade::sim {
namespace {

constexpr double kStep = 0.01;          // s between control points
constexpr double kLimitSpacing = 0.02;  // m between the points at which limits are looked up
constexpr double kSlowest = 0.05;       // m/s; no limit is lower, so that every path ends

// A stretch of constant acceleration, or a rest (length 0).
struct Piece {
  double duration = 0.0;
  double speed0 = 0.0;
  double speed1 = 0.0;
};

double speedLimitAt(const Path& path, double s, const std::vector<SpeedLimit>& limits,
                    const SpeedOptions& options) {
  const PathPoint point = path.at(s);
  double limit = point.direction > 0 ? options.max_speed : options.max_reverse_speed;
  const double curvature = std::abs(point.curvature);
  if (curvature > 1e-9) limit = std::min(limit, std::sqrt(options.max_lateral / curvature));
  for (const SpeedLimit& range : limits) {
    if (s >= range.s_begin && s <= range.s_end) limit = std::min(limit, range.speed);
  }
  return std::max(limit, kSlowest);
}

// From rest at s0 to rest at s1.
void appendRun(const Path& path, double s0, double s1, const std::vector<SpeedLimit>& limits,
               const SpeedOptions& options, std::vector<Piece>& pieces) {
  const int count = std::max(2, static_cast<int>(std::ceil((s1 - s0) / kLimitSpacing)));
  const double ds = (s1 - s0) / count;
  std::vector<double> speed(count + 1);
  for (int i = 0; i <= count; ++i) speed[i] = speedLimitAt(path, s0 + i * ds, limits, options);
  speed.front() = speed.back() = 0.0;
  const double gain = 2.0 * options.max_longitudinal * ds;  // of the squared speed per step
  for (int i = 1; i <= count; ++i) {
    speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + gain));
  }
  for (int i = count - 1; i >= 0; --i) {
    speed[i] = std::min(speed[i], std::sqrt(speed[i + 1] * speed[i + 1] + gain));
  }
  for (int i = 0; i < count; ++i) {
    pieces.push_back({2.0 * ds / (speed[i] + speed[i + 1]), speed[i], speed[i + 1]});
  }
}

// The distance at times first, first + kStep, ... until the time last.
std::vector<double> sampleDistance(const std::vector<Piece>& pieces, double first, double last) {
  std::vector<double> samples;
  std::size_t piece = 0;
  double piece_start = 0.0;
  double distance = 0.0;  // at piece_start
  const auto travelled = [](const Piece& p, double tau) {
    return p.speed0 * tau + 0.5 * (p.speed1 - p.speed0) / p.duration * tau * tau;
  };
  for (std::size_t i = 0; first + static_cast<double>(i) * kStep <= last; ++i) {
    const double t = first + static_cast<double>(i) * kStep;
    while (piece < pieces.size() && t >= piece_start + pieces[piece].duration) {
      distance += travelled(pieces[piece], pieces[piece].duration);
      piece_start += pieces[piece].duration;
      ++piece;
    }
    const bool moving = t > 0.0 && piece < pieces.size();
    samples.push_back(distance + (moving ? travelled(pieces[piece], t - piece_start) : 0.0));
  }
  return samples;
}

// Mean over a centred window of 2 * half + 1 samples; ends are held.
std::vector<double> boxFilter(const std::vector<double>& samples, int half) {
  const int count = static_cast<int>(samples.size());
  std::vector<double> result(samples.size());
  for (int i = 0; i < count; ++i) {
    double sum = 0.0;
    for (int k = -half; k <= half; ++k) sum += samples[std::clamp(i + k, 0, count - 1)];
    result[i] = sum / (2 * half + 1);
  }
  return result;
}

}  // namespace

SpeedProfile::SpeedProfile(const Path& path, std::vector<Stop> stops,
                           const std::vector<SpeedLimit>& limits, const SpeedOptions& options) {
  PARKADE_CHECK(options.max_longitudinal > 0.0 && options.max_lateral > 0.0,
                "accelerations of {} and {} m/s^2", options.max_longitudinal, options.max_lateral);
  for (const double s : path.gearChanges()) stops.push_back({s, options.gear_standstill});
  std::sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.s < b.s; });
  // The kernel eats half of its width at each side of a rest.
  const double rounding = options.jerk_time;
  std::vector<Piece> pieces{{options.start_standstill + 0.5 * rounding, 0.0, 0.0}};
  double s = 0.0;
  constexpr double kShortest = 0.5;  // m between two stops; nearer ones are one
  for (const Stop& stop : stops) {
    const bool gear_change = std::find(path.gearChanges().begin(), path.gearChanges().end(),
                                       stop.s) != path.gearChanges().end();
    if (!gear_change && (stop.s < s + kShortest || stop.s > path.length() - kShortest)) continue;
    appendRun(path, s, stop.s, limits, options, pieces);
    pieces.push_back({stop.duration + rounding, 0.0, 0.0});
    s = stop.s;
  }
  appendRun(path, s, path.length(), limits, options, pieces);
  pieces.push_back({options.end_standstill + 0.5 * rounding, 0.0, 0.0});
  for (const Piece& piece : pieces) duration_ += piece.duration;

  constexpr int kMargin = UniformSpline<1>::kMargin;
  std::vector<double> samples =
      sampleDistance(pieces, -kMargin * kStep, duration_ + (kMargin + 1) * kStep);
  const int half = static_cast<int>(std::lround(options.jerk_time / 3.0 / kStep / 2.0));
  for (int pass = 0; pass < 3; ++pass) samples = boxFilter(samples, half);
  std::vector<UniformSpline<1>::Vector> points;
  points.reserve(samples.size());
  for (const double sample : samples) points.emplace_back(sample);
  distance_ = UniformSpline<1>(-kMargin * kStep, kStep, std::move(points));
}

double SpeedProfile::distance(double t) const {
  return distance_.evaluate(std::clamp(t, 0.0, duration_))[0];
}

double SpeedProfile::speed(double t) const {
  return std::max(0.0, distance_.evaluate(std::clamp(t, 0.0, duration_), 1)[0]);
}

double SpeedProfile::acceleration(double t) const {
  return distance_.evaluate(std::clamp(t, 0.0, duration_), 2)[0];
}

}  // namespace parkade::sim
