// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/slot_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "parkade/core/median.hpp"
#include "parkade/mapping/layers/slot_edges.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

// How edges of one kind are painted: the share that shows a line at each distance, of those that
// are painted at all.
struct Pattern {
  double painted = 0.0;
  std::vector<double> shares;
};

Pattern learnPattern(const std::vector<const SlotEdge*>& edges) {
  constexpr int kFewest = 6;
  Pattern pattern;
  int painted = 0;
  int told = 0;
  std::vector<std::pair<int, int>> counts;  // seen, shows
  for (const SlotEdge* edge : edges) {
    if (!edge->isSeen()) continue;
    ++told;
    if (!edge->isPainted()) continue;
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
    for (double s = SlotEdge::kCorner; s <= edge.length() - SlotEdge::kCorner; s += step) {
      if (!edge.bins[edge.binOf(s)].shows) continue;
      int cells = 0;
      for (double t = -SlotEdge::kAcross; t <= SlotEdge::kAcross + 1e-9; t += 0.25 * step) {
        cells += showsSlotLine(grid, edge.from + s * edge.along() + t * edge.across()) ? 1 : 0;
      }
      if (cells > 0) widths.push_back(0.25 * step * cells);
    }
  }
  return widths.empty() ? 0.0 : median(std::move(widths));
}

// Slots of a row are painted alike: whether so many of its entrances, or rears, show their line
// that all have one.
bool isPaintedRow(const std::vector<const SlotEdge*>& row) {
  constexpr int kFewest = 2;
  constexpr double kFronts = 0.65;
  constexpr double kRears = 0.2;  // farther away, and seldom seen whole
  int seen = 0;
  int show = 0;
  for (const SlotEdge* edge : row) {
    if (!edge->isSeen()) continue;
    ++seen;
    show += edge->isPainted() ? 1 : 0;
  }
  const double least = row.front()->kind == SlotEdgeKind::kFront ? kFronts : kRears;
  return show >= kFewest && show >= least * seen;
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
  const std::vector<SlotEdge> edges = slotEdges(slots, grid);
  std::map<std::pair<SlotEdgeKind, SlotShape>, std::vector<const SlotEdge*>> kinds;
  for (const SlotEdge& edge : edges) kinds[{edge.kind, edge.shape}].push_back(&edge);
  const double width = lineWidth(edges, grid);
  for (const auto& [kind, alike] : kinds) {
    const Pattern pattern = learnPattern(alike);
    for (const SlotEdge* edge : alike) {
      if (!pattern.shares.empty() && paintedLogOdds(*edge, pattern) > kLikely) {
        paint(*edge, pattern, width, grid);
      }
    }
    if (kind.first == SlotEdgeKind::kSide) continue;
    for (const std::vector<const SlotEdge*>& row : rowsOfEdges(alike)) {
      if (!isPaintedRow(row)) continue;
      for (const SlotEdge* edge : row) {
        paint(*edge, {1.0, std::vector<double>(edge->bins.size(), 1.0)}, width, grid);
      }
    }
  }
}

}  // namespace parkade
