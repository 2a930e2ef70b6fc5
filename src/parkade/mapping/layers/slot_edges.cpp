// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/slot_edges.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kNearWidth = 0.1;  // m to either side of the line itself

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
    for (double t = -SlotEdge::kAcross; t <= SlotEdge::kAcross; t += step) {
      if (showsSlotLine(grid, edge.from + s * edge.along() + t * edge.across()))
        points.push_back({s, t});
    }
  }
  if (points.size() < kFewest) return;
  double offset = 0.0;
  double turn = 0.0;
  double middle = 0.0;
  for (const double reach : {SlotEdge::kAcross, 0.5 * SlotEdge::kAcross}) {
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
      if (!showsSlotLine(grid, p + t * across)) continue;
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

// Whether two entrances, or two rears, belong to slots of one row that are as wide.
bool standTogether(const SlotEdge& a, const SlotEdge& b) {
  constexpr double kAlongside = 0.9945;  // cosine of 6 degrees
  constexpr double kOff = 0.35;          // m off one line
  constexpr double kApart = 3.5;         // m between their ends: a pillar
  constexpr double kAsWide = 0.35;       // m
  if (a.kind != b.kind || a.shape != b.shape || std::abs(a.length() - b.length()) > kAsWide ||
      std::abs(a.along().dot(b.along())) < kAlongside) {
    return false;
  }
  const Vector2d between = 0.5 * (b.from + b.to - a.from - a.to);
  return std::abs(a.across().dot(between)) < kOff &&
         std::abs(a.along().dot(between)) < 0.5 * (a.length() + b.length()) + kApart;
}

}  // namespace

bool showsSlotLine(const LayeredGrid& grid, const Vector2d& p) {
  return grid.at(GridLayer::kParkingLines, grid.cellOf(p)).believed() == SemanticClass::kSlotLine;
}

std::vector<SlotEdge> slotEdges(const std::vector<MapSlot>& slots, const LayeredGrid& grid) {
  std::vector<SlotEdge> edges = edgesOf(slots);
  for (SlotEdge& edge : edges) {
    alignEdge(grid, edge);
    judgeBins(grid, edge);
  }
  return edges;
}

std::vector<std::vector<const SlotEdge*>> rowsOfEdges(const std::vector<const SlotEdge*>& edges) {
  std::vector<std::vector<const SlotEdge*>> rows;
  for (const SlotEdge* edge : edges) {
    std::vector<const SlotEdge*> row{edge};
    const auto joins = [&](const std::vector<const SlotEdge*>& other) {
      return std::any_of(other.begin(), other.end(),
                         [&](const SlotEdge* member) { return standTogether(*member, *edge); });
    };
    for (auto it = rows.begin(); it != rows.end();) {
      if (joins(*it)) {
        row.insert(row.end(), it->begin(), it->end());
        it = rows.erase(it);
      } else {
        ++it;
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace parkade
