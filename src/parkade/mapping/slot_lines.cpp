// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slot_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "parkade/core/median.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr double kBin = 0.25;       // m of an edge that are judged together
constexpr double kAcross = 0.2;     // m to either side of an edge, within which its line lies
constexpr double kNearWidth = 0.1;  // m to either side of the line itself
constexpr double kCorner = 0.2;     // m from an edge's end, where other lines cross it
constexpr double kBar = 0.5;        // m from a corner, where a T or an L has its bar

enum class SlotEdgeKind : std::uint8_t { kSide, kFront, kRear };

// What of a bin is in sight, and whether it is line there.
struct Bin {
  bool seen = false;
  bool shows = false;
};

struct SlotEdge {
  Vector2d from;  // sides: at the entrance
  Vector2d to;
  SlotEdgeKind kind;
  SlotShape shape;
  std::vector<Bin> bins;

  [[nodiscard]] double length() const { return (to - from).norm(); }
  [[nodiscard]] double margin() const { return kind == SlotEdgeKind::kSide ? kCorner : kBar; }
  [[nodiscard]] Vector2d along() const { return (to - from).normalized(); }
  [[nodiscard]] Vector2d across() const { return {-along().y(), along().x()}; }
  // Lines across begin at both of its corners alike.
  [[nodiscard]] double distance(double s) const {
    return kind == SlotEdgeKind::kSide ? s : std::min(s, length() - s);
  }
  [[nodiscard]] std::size_t binOf(double s) const {
    return static_cast<std::size_t>(std::max(0.0, distance(s)) / kBin);
  }
};

bool isLine(const LayeredGrid& grid, const Vector2d& p) {
  return grid.at(GridLayer::kParkingLines, grid.cellOf(p)).believed() == SemanticClass::kSlotLine;
}

bool isKnown(const LayeredGrid& grid, const Vector2d& p) {
  return grid.at(GridLayer::kParkingLines, grid.cellOf(p)).known();
}

// Neighbours share a side, and rows back to back their rears.
bool isSame(const SlotEdge& a, const SlotEdge& b) {
  constexpr double kSame = 0.35;  // m
  const auto near = [&](const Vector2d& p, const Vector2d& q) { return (p - q).norm() < kSame; };
  return (near(a.from, b.from) && near(a.to, b.to)) || (near(a.from, b.to) && near(a.to, b.from));
}

std::vector<SlotEdge> edgesOf(const std::vector<MapSlot>& slots) {
  std::vector<SlotEdge> edges;
  const auto add = [&](const Vector2d& from, const Vector2d& to, SlotEdgeKind kind,
                       SlotShape shape) {
    SlotEdge edge{from, to, kind, shape, {}};
    if (edge.length() < 1.0) return;
    if (std::any_of(edges.begin(), edges.end(),
                    [&](const SlotEdge& other) { return isSame(edge, other); })) {
      return;
    }
    edges.push_back(std::move(edge));
  };
  for (const MapSlot& slot : slots) {
    const auto& c = slot.corners;
    add(c[0], c[3], SlotEdgeKind::kSide, slot.shape);
    add(c[1], c[2], SlotEdgeKind::kSide, slot.shape);
    add(c[0], c[1], SlotEdgeKind::kFront, slot.shape);
    add(c[3], c[2], SlotEdgeKind::kRear, slot.shape);
  }
  return edges;
}

// Moves an edge onto the line that the layer holds beside it: a straight line through its cells.
void alignEdge(const LayeredGrid& grid, SlotEdge& edge) {
  constexpr std::size_t kFewest = 12;
  constexpr double kScatter = 0.15;  // m, of a cell, as cells beside each other err together
  constexpr double kTurn = 0.009;    // rad, that a told slot's edge is wrong by
  const double step = grid.resolution();
  std::vector<Vector2d> points;  // along, across
  for (double s = edge.margin(); s <= edge.length() - edge.margin(); s += step) {
    for (double t = -kAcross; t <= kAcross; t += step) {
      if (isLine(grid, edge.from + s * edge.along() + t * edge.across())) points.push_back({s, t});
    }
  }
  if (points.size() < kFewest) return;
  double offset = 0.0;
  double turn = 0.0;
  double middle = 0.0;
  for (const double reach : {kAcross, 0.5 * kAcross}) {
    Vector2d mean = Vector2d::Zero();
    double n = 0.0;
    const auto fits = [&](const Vector2d& p) {
      return std::abs(p.y() - offset - turn * (p.x() - middle)) <= reach + 0.5 * step;
    };
    for (const Vector2d& p : points) {
      if (!fits(p)) continue;
      mean += p;
      n += 1.0;
    }
    if (n < static_cast<double>(kFewest)) return;
    mean /= n;
    double xx = 0.0;
    double xy = 0.0;
    for (const Vector2d& p : points) {
      if (!fits(p)) continue;
      xx += (p.x() - mean.x()) * (p.x() - mean.x());
      xy += (p.x() - mean.x()) * (p.y() - mean.y());
    }
    middle = mean.x();
    offset = mean.y();
    turn = xy / (xx + kScatter * kScatter / (kTurn * kTurn));
  }
  const Vector2d across = edge.across();
  const double length = edge.length();
  edge.from += (offset - turn * middle) * across;
  edge.to += (offset + turn * (length - middle)) * across;
}

void judgeBins(const LayeredGrid& grid, SlotEdge& edge) {
  const double step = grid.resolution();
  const Vector2d along = edge.along();
  const Vector2d across = edge.across();
  std::vector<std::array<int, 3>> counts(
      edge.binOf(edge.kind == SlotEdgeKind::kSide ? edge.length() : 0.5 * edge.length()) + 1);
  for (double s = edge.margin(); s <= edge.length() - edge.margin(); s += step) {
    const Vector2d p = edge.from + s * along;
    auto& [all, known, line] = counts[edge.binOf(s)];
    ++all;
    if (!isKnown(grid, p)) continue;
    ++known;
    for (double t = -kNearWidth; t <= kNearWidth; t += step) {
      if (!isLine(grid, p + t * across)) continue;
      ++line;
      break;
    }
  }
  edge.bins.resize(counts.size());
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const auto& [all, known, line] = counts[k];
    edge.bins[k].seen = all > 0 && 2 * known >= all;
    edge.bins[k].shows = edge.bins[k].seen && 2 * line >= known;
  }
}

// How edges of one kind are painted: the share that shows a line at each distance, of those that
// are painted at all.
struct Pattern {
  double painted = 0.0;
  std::vector<double> shares;
};

Pattern learnPattern(const std::vector<const SlotEdge*>& edges) {
  constexpr int kFewest = 6;
  constexpr double kSome = 0.25;
  Pattern pattern;
  int painted = 0;
  int told = 0;
  std::vector<std::pair<int, int>> counts;  // seen, shows
  for (const SlotEdge* edge : edges) {
    const auto seen = std::count_if(edge->bins.begin(), edge->bins.end(),
                                    [](const Bin& bin) { return bin.seen; });
    const auto shows = std::count_if(edge->bins.begin(), edge->bins.end(),
                                     [](const Bin& bin) { return bin.shows; });
    if (seen < 2) continue;
    ++told;
    if (static_cast<double>(shows) < kSome * static_cast<double>(seen)) continue;
    ++painted;
    counts.resize(std::max(counts.size(), edge->bins.size()));
    for (std::size_t k = 0; k < edge->bins.size(); ++k) {
      counts[k].first += edge->bins[k].seen ? 1 : 0;
      counts[k].second += edge->bins[k].shows ? 1 : 0;
    }
  }
  if (painted < kFewest) return pattern;
  pattern.painted = (painted + 0.5) / (told + 1.0);
  for (const auto& [seen, shows] : counts) {
    pattern.shares.push_back(seen >= kFewest ? static_cast<double>(shows) / seen : 0.0);
  }
  return pattern;
}

constexpr double kLeastShare = 0.25;  // of edges that show a line where all have one

// Log-odds of an edge being painted, by where it shows a line.
double paintedLogOdds(const SlotEdge& edge, const Pattern& pattern) {
  constexpr double kChance = 0.05;  // of a line that shows where none is
  constexpr double kRepeat = 0.5;   // bins beside each other are worn together
  constexpr double kWorn = -2.0;    // at least: lines are worn off as a whole
  double sum = 0.0;
  for (std::size_t k = 0; k < std::min(edge.bins.size(), pattern.shares.size()); ++k) {
    const double share = std::min(pattern.shares[k], 0.95);
    if (!edge.bins[k].seen || share < kLeastShare) continue;
    sum += kRepeat * (edge.bins[k].shows ? std::log(share / kChance)
                                         : std::log((1.0 - share) / (1.0 - kChance)));
  }
  // A slot has sides, whatever the wear: bare floor does not speak against them.
  const double worn = edge.kind == SlotEdgeKind::kSide ? 0.0 : kWorn;
  return std::log(pattern.painted / (1.0 - pattern.painted)) + std::max(worn, sum);
}

double lineWidth(const std::vector<SlotEdge>& edges, const LayeredGrid& grid) {
  const double step = grid.resolution();
  std::vector<double> widths;
  for (const SlotEdge& edge : edges) {
    if (edge.kind != SlotEdgeKind::kSide) continue;
    for (double s = kCorner; s <= edge.length() - kCorner; s += step) {
      if (!edge.bins[edge.binOf(s)].shows) continue;
      int cells = 0;
      for (double t = -kAcross; t <= kAcross + 1e-9; t += 0.25 * step) {
        cells += isLine(grid, edge.from + s * edge.along() + t * edge.across()) ? 1 : 0;
      }
      if (cells > 0) widths.push_back(0.25 * step * cells);
    }
  }
  return widths.empty() ? 0.0 : median(std::move(widths));
}

void paint(const SlotEdge& edge, const Pattern& pattern, double width, LayeredGrid& grid) {
  constexpr float kLogOdds = 1.0F;  // against what was seen there
  const double step = 0.5 * grid.resolution();
  const Vector2d along = edge.along();
  const Vector2d across = edge.across();
  for (double s = -0.5 * width; s <= edge.length() + 0.5 * width; s += step) {
    const std::size_t bin = edge.binOf(std::clamp(s, edge.margin(), edge.length() - edge.margin()));
    if (bin >= pattern.shares.size() || pattern.shares[bin] < kLeastShare) continue;
    for (double t = -0.5 * width; t <= 0.5 * width + 1e-9; t += step) {
      const Vector2i cell = grid.cellOf(edge.from + s * along + t * across);
      const GridCell now = grid.at(GridLayer::kParkingLines, cell);
      if (!now.known() || now.believed() == SemanticClass::kSlotLine ||
          now.believed() == SemanticClass::kLaneLine) {
        continue;
      }
      const Vector2d middle = grid.centerOf(cell) - edge.from;
      if (std::abs(middle.dot(across)) > 0.5 * width) continue;
      grid.set(GridLayer::kParkingLines, cell, SemanticClass::kSlotLine, kLogOdds);
    }
  }
}

}  // namespace

void completeSlotLines(const std::vector<MapSlot>& slots, LayeredGrid& grid) {
  constexpr double kLikely = 1.0;  // log-odds
  std::vector<SlotEdge> edges = edgesOf(slots);
  std::map<std::pair<SlotEdgeKind, SlotShape>, std::vector<const SlotEdge*>> kinds;
  for (SlotEdge& edge : edges) {
    alignEdge(grid, edge);
    judgeBins(grid, edge);
    kinds[{edge.kind, edge.shape}].push_back(&edge);
  }
  const double width = lineWidth(edges, grid);
  for (const auto& [kind, alike] : kinds) {
    const Pattern pattern = learnPattern(alike);
    if (pattern.shares.empty()) continue;
    for (const SlotEdge* edge : alike) {
      if (paintedLogOdds(*edge, pattern) > kLikely) paint(*edge, pattern, width, grid);
    }
  }
}

}  // namespace parkade
