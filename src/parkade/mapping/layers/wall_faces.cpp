// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/wall_points.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLowest = 0.3;      // m above the floor
constexpr double kHigh = 1.7;        // m: higher than cars
constexpr double kHighest = 2.8;     // m
constexpr double kAcrossBin = 0.08;  // m across a line, when lines are looked for
constexpr double kBeside = 0.4;      // m: a wall has nothing so near to it, cars have
constexpr double kGap = 3.0;         // m between points of one piece: doors and passages are wider
constexpr double kShortest = 4.0;    // m
constexpr int kFewest = 10;          // points
constexpr double kOwnShare = 0.7;    // of the points beside a piece, those that lie on it
constexpr double kCovered = 0.35;    // of a piece's half metres, those with a point
constexpr double kLevelled = 0.5;    // of a piece's metres, those with a high point, and a low one

// A point by how far it lies along a direction and across it.
struct Turned {
  double along = 0.0;
  double across = 0.0;
  bool high = false;
};

std::vector<Turned> turn(const std::vector<Vector3d>& places, double angle) {
  const Vector2d along(std::cos(angle), std::sin(angle));
  std::vector<Turned> turned;
  turned.reserve(places.size());
  for (const Vector3d& p : places) {
    if (p.z() < kLowest || p.z() > kHighest) continue;
    turned.push_back(
        {along.dot(p.head<2>()), along.x() * p.y() - along.y() * p.x(), p.z() > kHigh});
  }
  return turned;
}

// A pillar beside a car makes their points one line, high and low.
std::vector<Vector3d> withoutPillars(const std::vector<Vector3d>& places,
                                     const std::vector<MapObject>& objects) {
  constexpr double kReach = 0.8;  // m from a pillar's middle
  const std::vector<Vector2d> pillars = positionsOf(SemanticClass::kPillar, objects);
  std::vector<Vector3d> others;
  for (const Vector3d& p : places) {
    if (std::none_of(pillars.begin(), pillars.end(), [&](const Vector2d& pillar) {
          return (pillar - p.head<2>()).norm() < kReach;
        })) {
      others.push_back(p);
    }
  }
  return others;
}

int binOf(double across) {
  return static_cast<int>(std::floor(across / kAcrossBin));
}

std::map<int, int> histogram(const std::vector<Turned>& points) {
  std::map<int, int> counts;
  for (const Turned& p : points) ++counts[binOf(p.across)];
  return counts;
}

// Of a quarter turn, the direction that, with the one square to it, points line up with best.
double mainDirection(const std::vector<Vector3d>& all) {
  constexpr int kSteps = 180;
  constexpr std::size_t kEnough = 4000;  // points
  std::vector<Vector3d> places;
  const std::size_t stride = 1 + all.size() / kEnough;
  for (std::size_t k = 0; k < all.size(); k += stride) places.push_back(all[k]);
  double best = -1.0;
  double direction = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 0.5 * M_PI * k / kSteps;
    double squares = 0.0;
    for (const double square : {0.0, 0.5 * M_PI}) {
      for (const auto& [bin, count] : histogram(turn(places, angle + square))) {
        squares += static_cast<double>(count) * count;
      }
    }
    if (squares <= best) continue;
    best = squares;
    direction = angle;
  }
  return direction;
}

// across = offset + slope * along
struct Line {
  double offset = 0.0;
  double slope = 0.0;
  [[nodiscard]] double off(const Turned& p) const { return p.across - offset - slope * p.along; }
};

// Least squares over the points near a line, three times closer each; at last on_face m off it.
std::optional<Line> fitLine(const std::vector<Turned>& points, double across, double on_face) {
  Line line{across, 0.0};
  for (const double near : {2.0 * on_face, 1.4 * on_face, on_face}) {
    double n = 0.0;
    double s = 0.0;
    double ss = 0.0;
    double a = 0.0;
    double sa = 0.0;
    for (const Turned& p : points) {
      if (std::abs(line.off(p)) > near) continue;
      n += 1.0;
      s += p.along;
      ss += p.along * p.along;
      a += p.across;
      sa += p.along * p.across;
    }
    const double spread = ss * n - s * s;
    if (n < kFewest || !(spread > n)) return std::nullopt;
    line.slope = (sa * n - s * a) / spread;
    line.offset = (a - line.slope * s) / n;
  }
  return line;
}

// Places along a line, in order: of the points on it, of those high up and low down, and of all
// that lie beside it.
struct Along {
  std::vector<double> on;
  std::vector<double> high;
  std::vector<double> low;
  std::vector<double> beside;

  void sort() {
    for (std::vector<double>* places : {&on, &high, &low, &beside}) {
      std::sort(places->begin(), places->end());
    }
  }
};

double countBetween(const std::vector<double>& places, double low, double high) {
  const auto begin = std::lower_bound(places.begin(), places.end(), low);
  return static_cast<double>(std::upper_bound(begin, places.end(), high) - begin);
}

// Of the lengths that a piece is cut into, the share that holds a place.
double coverage(const std::vector<double>& places, double begin, double end, double length) {
  const int count = std::max(1, static_cast<int>(std::lround((end - begin) / length)));
  int covered = 0;
  for (int k = 0; k < count; ++k) {
    const double low = begin + (end - begin) * k / count;
    covered += countBetween(places, low, low + (end - begin) / count) > 0.0 ? 1 : 0;
  }
  return static_cast<double>(covered) / count;
}

struct Piece {
  std::size_t first = 0;
  std::size_t last = 0;
};

// Takes the ends off that lead on, past a wall's corner, into what stands beside it: of the points
// beside an end's last metres half are its own, and some are high.
void trim(const Along& places, Piece& piece) {
  constexpr double kEnds[] = {0.75, 2.0};  // m
  constexpr double kHighEnd = 2.0;
  constexpr double kOwnEnd = 0.5;
  const auto belongs = [&](double end, double inwards) {
    const auto count = [&](const std::vector<double>& of, double length) {
      return countBetween(of, std::min(end, end + inwards * length),
                          std::max(end, end + inwards * length));
    };
    return count(places.high, kHighEnd) > 0.0 &&
           std::all_of(std::begin(kEnds), std::end(kEnds), [&](double length) {
             return count(places.on, length) >= kOwnEnd * count(places.beside, length);
           });
  };
  const std::vector<double>& on = places.on;
  while (piece.first < piece.last && !belongs(on[piece.first], 1.0)) ++piece.first;
  while (piece.first < piece.last && !belongs(on[piece.last], -1.0)) --piece.last;
}

bool isFace(const Along& places, const Piece& piece) {
  const double begin = places.on[piece.first];
  const double end = places.on[piece.last];
  const auto count = static_cast<double>(piece.last - piece.first + 1);
  return end - begin >= kShortest && count >= kFewest &&
         count >= kOwnShare * countBetween(places.beside, begin, end) &&
         coverage(places.on, begin, end, 0.5) >= kCovered &&
         coverage(places.high, begin, end, 1.0) >= kLevelled &&
         coverage(places.low, begin, end, 1.0) >= kLevelled;
}

// The pieces of a line between its gaps that are faces.
std::vector<std::pair<double, double>> piecesOf(const Along& places) {
  const std::vector<double>& on = places.on;
  std::vector<std::pair<double, double>> pieces;
  for (std::size_t i = 0; i < on.size();) {
    Piece piece{i, i};
    while (piece.last + 1 < on.size() && on[piece.last + 1] - on[piece.last] <= kGap) ++piece.last;
    i = piece.last + 1;
    trim(places, piece);
    if (isFace(places, piece)) pieces.emplace_back(on[piece.first], on[piece.last]);
  }
  return pieces;
}

Along placesBy(const Line& line, const std::vector<Turned>& points, double on_face) {
  Along places;
  for (const Turned& p : points) {
    const double off = std::abs(line.off(p));
    if (off < kBeside) places.beside.push_back(p.along);
    if (off >= on_face) continue;
    places.on.push_back(p.along);
    (p.high ? places.high : places.low).push_back(p.along);
  }
  places.sort();
  return places;
}

void findAlong(const std::vector<Vector3d>& places, double angle, double on_face,
               std::vector<WallFace>& faces) {
  constexpr double kSameWall = 0.2;  // m off a face
  std::vector<Turned> points = turn(places, angle);
  std::map<int, int> counts = histogram(points);
  const Vector2d along(std::cos(angle), std::sin(angle));
  const Vector2d across(-along.y(), along.x());
  while (true) {
    const auto most =
        std::max_element(counts.begin(), counts.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == counts.end() || most->second < kFewest) return;
    const int bin = most->first;
    most->second = 0;
    const std::optional<Line> line = fitLine(points, (bin + 0.5) * kAcrossBin, on_face);
    if (!line) continue;
    for (const auto& [begin, end] : piecesOf(placesBy(*line, points, on_face))) {
      const auto at = [&](double s) -> Vector2d {
        return s * along + (line->offset + line->slope * s) * across;
      };
      faces.push_back({at(begin), at(end)});
      const auto taken = [&, low = begin, high = end](const Turned& p) {
        return p.along >= low && p.along <= high && std::abs(line->off(p)) < kSameWall;
      };
      for (const Turned& p : points) counts[binOf(p.across)] -= taken(p) ? 1 : 0;
      points.erase(std::remove_if(points.begin(), points.end(), taken), points.end());
    }
  }
}

}  // namespace

std::vector<WallFace> findWallFaces(const std::vector<Vector3d>& places,
                                    const std::vector<MapObject>& objects, double on_face) {
  const std::vector<Vector3d> others = withoutPillars(places, objects);
  std::vector<WallFace> faces;
  const double angle = mainDirection(others);
  findAlong(others, angle, on_face, faces);
  findAlong(others, angle + 0.5 * M_PI, on_face, faces);
  return faces;
}

}  // namespace parkade
