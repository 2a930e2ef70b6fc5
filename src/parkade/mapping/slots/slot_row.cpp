// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/slot_row.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parkade/geometry/planar.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

Vector2d frontOf(const MapSlot& slot) {
  return slot.corners[1] - slot.corners[0];
}

double weightOf(const MapSlot& slot) {
  constexpr double kFloor = 0.03;  // m: neighbours' corners lie no better in one line
  return 1.0 / (slot.corner_sigma * slot.corner_sigma + kFloor * kFloor);
}

Row makeRow(const std::vector<MapSlot>& slots, const std::vector<std::size_t>& of_row) {
  Row row;
  Vector2d front = Vector2d::Zero();
  for (const std::size_t i : of_row) front += weightOf(slots[i]) * frontOf(slots[i]).normalized();
  row.origin = slots[of_row.front()].entrance();
  row.u = front.normalized();
  // The line through all corners (which also lie far enough apart to tell its direction better),
  // those least that are far off: one misread corner turns a row by degrees.
  constexpr int kRounds = 8;
  constexpr double kFar = 0.05;  // m
  double far = 1e3;              // all alike at first
  for (int round = 0; round < kRounds; ++round, far = kFar) {
    const Vector2d n(-row.u.y(), row.u.x());
    const auto weightAt = [&](const MapSlot& slot, const Vector2d& corner) {
      const double off = n.dot(corner - row.origin) / far;
      return weightOf(slot) / (1.0 + off * off);
    };
    Vector2d mean = Vector2d::Zero();
    double weights = 0.0;
    for (const std::size_t i : of_row) {
      for (std::size_t k = 0; k < 2; ++k) {
        const double w = weightAt(slots[i], slots[i].corners[k]);
        mean += w * slots[i].corners[k];
        weights += w;
      }
    }
    mean /= weights;
    double ss = 0.0;
    double sn = 0.0;
    for (const std::size_t i : of_row) {
      for (std::size_t k = 0; k < 2; ++k) {
        const Vector2d d = slots[i].corners[k] - mean;
        const double w = weightAt(slots[i], slots[i].corners[k]);
        ss += w * d.dot(row.u) * d.dot(row.u);
        sn += w * d.dot(row.u) * d.dot(n);
      }
    }
    row.origin = mean;
    row.u = (row.u + sn / ss * n).normalized();
  }
  for (const std::size_t i : of_row) {
    row.members.push_back({i, (slots[i].corners[0] - row.origin).dot(row.u),
                           (slots[i].corners[1] - row.origin).dot(row.u)});
  }
  std::sort(row.members.begin(), row.members.end(),
            [](const Member& a, const Member& b) { return a.begin < b.begin; });
  return row;
}

}  // namespace

bool areInOneRow(const MapSlot& a, const MapSlot& b) {
  constexpr double kParallel = 0.9945;  // cosine of 6 degrees
  constexpr double kOff = 0.35;         // m
  constexpr double kApart = 14.0;       // m
  const Vector2d u = frontOf(a).normalized();
  const Vector2d v = frontOf(b).normalized();
  const Vector2d between = b.entrance() - a.entrance();
  return u.dot(v) > kParallel && between.norm() < kApart &&
         std::abs(cross((u + v).normalized(), between)) < kOff;
}

bool liesOnLineOf(const MapSlot& slot, const Vector2d& from, const Vector2d& to) {
  constexpr double kSame = 0.4;      // m
  constexpr double kCosine = 0.966;  // of 15 degrees
  const Vector2d middle = 0.5 * (from + to);
  const Vector2d along = (to - from).normalized();
  for (std::size_t k = 0; k < slot.corners.size(); ++k) {
    const Vector2d& a = slot.corners[k];
    const Vector2d& b = slot.corners[(k + 1) % slot.corners.size()];
    if (std::abs(along.dot((b - a).normalized())) > kCosine &&
        distanceToSegment(middle, a, b) < kSame) {
      return true;
    }
  }
  return false;
}

std::vector<Row> findRows(const std::vector<MapSlot>& slots) {
  std::vector<std::size_t> root(slots.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t i = 0; i < slots.size(); ++i) {
    for (std::size_t j = i + 1; j < slots.size(); ++j) {
      if (areInOneRow(slots[i], slots[j])) root[find(j)] = find(i);
    }
  }
  std::vector<Row> rows;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (find(i) != i) continue;
    std::vector<std::size_t> of_row;
    for (std::size_t j = 0; j < slots.size(); ++j) {
      if (find(j) == i) of_row.push_back(j);
    }
    rows.push_back(makeRow(slots, of_row));
  }
  return rows;
}

}  // namespace parkade::slot_rows
