// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/lines/line_segments.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "parkade/geometry/planar.hpp"
#include "parkade/semantics/standing/tilt_error.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

struct Sample {
  Vector2d p;
  double sigma;
};

struct Piece {
  std::vector<Sample> samples;
  SemanticClass semantic_class = SemanticClass::kSlotLine;
  double width = 0.0;
  Vector2d middle = Vector2d::Zero();  // weighted mean
  Vector2d along = Vector2d::UnitX();
  double from = 0.0;  // m along, from the middle
  double to = 0.0;

  [[nodiscard]] Vector2d normal() const { return {-along.y(), along.x()}; }
  [[nodiscard]] double length() const { return to - from; }
  void fit();
};

void Piece::fit() {
  std::vector<double> factor(samples.size(), 1.0);
  for (int pass = 0; pass < 3; ++pass) {
    double sum = 0.0;
    Vector2d mean = Vector2d::Zero();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double w = factor[i] / (samples[i].sigma * samples[i].sigma);
      sum += w;
      mean += w * samples[i].p;
    }
    middle = mean / sum;
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double w = factor[i] / (samples[i].sigma * samples[i].sigma);
      const Vector2d d = samples[i].p - middle;
      spread += w * d * d.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
    solver.computeDirect(spread);
    along = solver.eigenvectors().col(1);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      constexpr double kHuber = 1.5;
      const double r = std::abs(normal().dot(samples[i].p - middle)) / samples[i].sigma;
      factor[i] = r > kHuber ? kHuber / r : 1.0;
    }
  }
  from = std::numeric_limits<double>::max();
  to = -from;
  for (const Sample& sample : samples) {
    const double s = along.dot(sample.p - middle);
    from = std::min(from, s);
    to = std::max(to, s);
  }
}

// Of the points between the first and the last, the farthest from the straight line between those:
// where a chain bends (Douglas and Peucker 1973). Far from a fit lies a bent chain's end.
std::size_t bendOf(const MeasuredLine& line, std::size_t first, std::size_t last) {
  const Vector2d begin = line.points[first].p_level;
  const Vector2d chord = line.points[last - 1].p_level - begin;
  std::size_t bend = first + (last - first) / 2;
  double farthest = 0.0;
  for (std::size_t i = first + 1; i + 1 < last; ++i) {
    const double off = std::abs(cross(chord, line.points[i].p_level - begin));
    if (off <= farthest) continue;
    farthest = off;
    bend = i;
  }
  return bend;
}

// Splits until every piece is straight.
void split(const MeasuredLine& line, std::size_t first, std::size_t last, double max_deviation,
           std::vector<Piece>& out) {
  constexpr std::size_t kLeast = 3;
  if (last - first < kLeast) return;
  Piece piece;
  piece.semantic_class = line.points.front().semantic_class;
  piece.width = line.width;
  for (std::size_t i = first; i < last; ++i) {
    piece.samples.push_back({line.points[i].p_level, line.sigmas[i]});
  }
  piece.fit();
  double off = 0.0;  // of the ends, which cannot be split off, nobody asks
  for (std::size_t i = first + 1; i + 1 < last; ++i) {
    off = std::max(off, std::abs(piece.normal().dot(line.points[i].p_level - piece.middle)));
  }
  if (off <= max_deviation) {
    out.push_back(std::move(piece));
    return;
  }
  const std::size_t bend = bendOf(line, first, last);
  split(line, first, bend + 1, max_deviation, out);
  split(line, bend, last, max_deviation, out);
}

bool joins(const Piece& a, const Piece& b, double max_gap) {
  if (a.semantic_class != b.semantic_class) return false;
  constexpr double kParallel = 0.0698;  // 4 degrees
  // Short pieces know their direction badly; the longer one's direction counts.
  const double shorter = std::min(a.length(), b.length());
  const double allowed = kParallel + 0.04 / std::max(shorter, 0.1);
  if (std::abs(a.along.dot(b.normal())) > std::sin(std::min(allowed, 0.35))) return false;
  const Piece& base = a.length() >= b.length() ? a : b;
  const Piece& other = a.length() >= b.length() ? b : a;
  const double s0 = base.along.dot(other.middle + other.from * other.along - base.middle);
  const double s1 = base.along.dot(other.middle + other.to * other.along - base.middle);
  const double gap = std::max(base.from - std::max(s0, s1), std::min(s0, s1) - base.to);
  if (gap > max_gap) return false;
  constexpr double kAside = 0.06;
  const auto aside = [&base](const Vector2d& p) {
    return std::abs(base.normal().dot(p - base.middle));
  };
  return aside(other.middle + other.from * other.along) < kAside &&
         aside(other.middle + other.to * other.along) < kAside;
}

void join(std::vector<Piece>& pieces, double max_gap) {
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.length() > b.length(); });
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (std::size_t j = pieces.size() - 1; j > i; --j) {
        Piece& a = pieces[i];
        Piece& b = pieces[j];
        if (!joins(a, b, max_gap)) continue;
        const auto m = static_cast<double>(a.samples.size());
        const auto n = static_cast<double>(b.samples.size());
        a.width = (m * a.width + n * b.width) / (m + n);
        a.samples.insert(a.samples.end(), b.samples.begin(), b.samples.end());
        a.fit();
        pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
        changed = true;
      }
    }
  }
}

LineSegment toSegment(const Piece& piece, double attitude_sigma, const SegmentOptions& options) {
  LineSegment segment;
  segment.begin = piece.middle + piece.from * piece.along;
  segment.end = piece.middle + piece.to * piece.along;
  segment.width = piece.width;
  segment.semantic_class = piece.semantic_class;
  double sigma = 0.0;
  for (const Sample& sample : piece.samples) sigma += sample.sigma;
  const auto n = static_cast<double>(piece.samples.size());
  sigma /= n;
  const double independent = 0.5 * n;  // neighbours share pixels
  const Vector2d ray = 0.5 * (segment.begin + segment.end) - options.viewpoint;
  const double h = options.camera_height_m;
  const double tilt = (groundTiltJacobian(ray, h) * piece.normal()).norm();
  segment.sigma_offset = std::hypot(sigma / std::sqrt(independent), attitude_sigma * tilt);
  // Along the line, what an error of the tilt moves it across changes by ray . normal / h.
  segment.sigma_heading =
      std::hypot(sigma * std::sqrt(12.0 / independent) / std::max(piece.length(), 1e-3),
                 attitude_sigma * ray.dot(piece.normal()) / h);
  return segment;
}

}  // namespace

std::vector<LineSegment> fitSegments(const std::vector<MeasuredLine>& lines, double attitude_sigma,
                                     const SegmentOptions& options) {
  std::vector<Piece> pieces;
  for (const MeasuredLine& line : lines) {
    split(line, 0, line.points.size(), options.max_deviation_m, pieces);
  }
  join(pieces, options.max_gap_m);
  std::vector<LineSegment> segments;
  for (const Piece& piece : pieces) {
    if (piece.length() < options.min_length_m) continue;
    segments.push_back(toSegment(piece, attitude_sigma, options));
  }
  return segments;
}

}  // namespace parkade
