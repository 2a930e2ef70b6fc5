// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/layout.hpp"

#include <algorithm>
#include <cmath>

namespace parkade::sim {
namespace {

constexpr double kRoomSetback = 0.2;  ///< of a room's wall behind the front of its row

double bayPitch(const GarageStyle& style) {
  return style.slots_per_bay * style.slot_width + pillarGap(style);
}

/// A horizontal or vertical run of room bays in grid coordinates.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;
};

std::vector<Run> runsOf(const std::string& row, char letter) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] != letter) continue;
    if (!runs.empty() && runs.back().last + 1 == i) {
      runs.back().last = i;
    } else {
      runs.push_back({i, i});
    }
  }
  return runs;
}

class Placer {
 public:
  Placer(const LayoutGrid& grid, const GarageStyle& style) : grid_(grid), style_(style) {}

  Layout place() {
    placeColumns();
    placeBands();
    placeRow(grid_.bottom, grid_.bottom_depth, grid_.bottom_depth, true);
    placeRow(grid_.top, layout_.max.y() - grid_.top_depth, grid_.top_depth, false);
    for (std::size_t i = 0; i < grid_.islands.size(); ++i) placeIsland(i);
    placeSide(grid_.left, true);
    placeSide(grid_.right, false);
    placeAisles();
    placeEntrance();
    for (std::size_t i = 0; i < layout_.rooms.size(); ++i) {
      layout_.rooms[i].id = static_cast<int>(i) + 1;
    }
    return std::move(layout_);
  }

 private:
  [[nodiscard]] double islandDepth() const { return 2.0 * (style_.slot_length + style_.row_gap); }

  void placeColumns() {
    const double pitch = bayPitch(style_);
    const double cross = std::max(pitch, style_.aisle_width + style_.pillar_size + 0.6);
    side_setback_ = std::min(style_.pillar_setback, 0.5 * (cross - style_.aisle_width));
    double x = grid_.left_depth - side_setback_;
    layout_.pillar_x.push_back(x);
    for (const char letter : grid_.bottom) {
      const double width = letter == '|' ? cross : pitch;
      if (letter == '|') layout_.cross_x.push_back(x + 0.5 * width);
      x += width;
      layout_.pillar_x.push_back(x);
    }
    layout_.max.x() = x - side_setback_ + grid_.right_depth;
  }

  void placeBands() {
    double y = grid_.bottom_depth;
    layout_.pillar_y.push_back(y - style_.pillar_setback);
    for (std::size_t i = 0; i <= grid_.islands.size(); ++i) {
      layout_.long_y.push_back(y + 0.5 * style_.aisle_width);
      y += style_.aisle_width;
      if (i == grid_.islands.size()) break;
      layout_.pillar_y.push_back(y + style_.pillar_setback);
      y += islandDepth();
      layout_.pillar_y.push_back(y - style_.pillar_setback);
    }
    layout_.pillar_y.push_back(y + style_.pillar_setback);
    layout_.max.y() = y + grid_.top_depth;
  }

  /// A row along x. Facing down: its depth lies below the front.
  void placeRow(const std::string& letters, double front_y, double depth, bool facing_down) {
    const double x_end = layout_.pillar_x.back();
    Row row;
    row.depth = depth;
    row.front = facing_down ? Frame2{{x_end, front_y}, M_PI} : Frame2{{0.0, front_y}, 0.0};
    for (std::size_t c = 0; c < letters.size(); ++c) {
      const double x0 = layout_.pillar_x[c];
      const double x1 = layout_.pillar_x[c + 1];
      if (letters[c] == '|') continue;
      row.bays.push_back(
          {facing_down ? x_end - x1 : x0, x1 - x0, static_cast<BayKind>(letters[c])});
    }
    layout_.rows.push_back(row);
    for (const Run& run : runsOf(letters, 'R')) {
      const double wall = facing_down ? front_y - depth : front_y + depth;
      const double face = facing_down ? front_y - kRoomSetback : front_y + kRoomSetback;
      addRoom(layout_.pillar_x[run.first], layout_.pillar_x[run.last + 1], std::min(wall, face),
              std::max(wall, face));
    }
  }

  void placeIsland(std::size_t index) {
    const LayoutGrid::Island& island = grid_.islands[index];
    const double lower = layout_.long_y[index] + 0.5 * style_.aisle_width;
    const double upper = lower + islandDepth();
    // Room bays of both rows make one room through the island; it is placed here, not by the rows.
    std::string lower_row = island.lower;
    std::string upper_row = island.upper;
    std::string both(lower_row.size(), ' ');
    for (std::size_t c = 0; c < both.size(); ++c) {
      if (lower_row[c] == 'R' && upper_row[c] == 'R') {
        both[c] = 'R';
        lower_row[c] = upper_row[c] = '|';
      }
    }
    for (const Run& run : runsOf(both, 'R')) {
      addRoom(layout_.pillar_x[run.first], layout_.pillar_x[run.last + 1], lower + kRoomSetback,
              upper - kRoomSetback);
    }
    placeRow(lower_row, lower, 0.5 * islandDepth(), false);
    placeRow(upper_row, upper, 0.5 * islandDepth(), true);
  }

  /// The row along the left or right wall, its bays between the pillar lines along y.
  void placeSide(const std::string& letters, bool left) {
    const double front = left ? grid_.left_depth : layout_.max.x() - grid_.right_depth;
    const double y_end = layout_.max.y();
    Row row;
    row.depth = left ? grid_.left_depth : grid_.right_depth;
    row.front = left ? Frame2{{front, 0.0}, M_PI_2} : Frame2{{front, y_end}, -M_PI_2};
    for (std::size_t i = 0; i < letters.size() && i + 1 < layout_.pillar_y.size(); ++i) {
      const double y0 = layout_.pillar_y[i];
      const double y1 = layout_.pillar_y[i + 1];
      row.bays.push_back({left ? y0 : y_end - y1, y1 - y0, static_cast<BayKind>(letters[i])});
    }
    layout_.rows.push_back(row);
    for (const Run& run : runsOf(letters, 'R')) {
      const double y0 = layout_.pillar_y[run.first] - 0.5 * style_.pillar_size;
      const double y1 = layout_.pillar_y[run.last + 1] + 0.5 * style_.pillar_size;
      const double x0 = left ? 0.0 : front + kRoomSetback;
      const double x1 = left ? front - kRoomSetback : layout_.max.x();
      layout_.rooms.push_back({0, {x0, y0}, {x1, y1}});
    }
  }

  /// Rooms swallow the pillars of their ends.
  void addRoom(double x0, double x1, double y0, double y1) {
    const double half = 0.5 * style_.pillar_size;
    layout_.rooms.push_back({0, {x0 - half, y0}, {x1 + half, y1}});
  }

  void placeAisles() {
    const double x0 = layout_.cross_x.front() - 0.5 * style_.aisle_width;
    const double x1 = layout_.cross_x.back() + 0.5 * style_.aisle_width;
    const double y0 = layout_.long_y.front() - 0.5 * style_.aisle_width;
    const double y1 = layout_.long_y.back() + 0.5 * style_.aisle_width;
    for (const double y : layout_.long_y) {
      layout_.aisles.push_back({{x0, y}, {x1, y}, style_.aisle_width, false});
    }
    for (const double x : layout_.cross_x) {
      layout_.aisles.push_back({{x, y0}, {x, y1}, style_.aisle_width, true});
    }
  }

  void placeEntrance() {
    if (grid_.entrance_aisle < 0) return;
    const double y = layout_.long_y[static_cast<std::size_t>(grid_.entrance_aisle)];
    layout_.entrances.push_back({{0.0, y}, 0.0, std::min(5.6, style_.aisle_width - 0.2)});
  }

  const LayoutGrid& grid_;
  const GarageStyle& style_;
  double side_setback_ = 1.15;
  Layout layout_;
};

}  // namespace

double pillarGap(const GarageStyle& style) {
  return style.pillar_size + style.line_width + 0.03;
}

Layout placeLayout(const LayoutGrid& grid, const GarageStyle& style) {
  return Placer(grid, style).place();
}

}  // namespace parkade::sim
