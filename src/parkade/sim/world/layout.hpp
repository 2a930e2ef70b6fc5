// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/sim/garage.hpp"
#include "parkade/sim/world/polygon.hpp"
#include "parkade/sim/world/style.hpp"

namespace parkade::sim {

/// What stands between two pillars of a row. The letters are those of LayoutGrid's rows.
enum class BayKind : char {
  kPerpendicular = 'P',
  kAccessible = 'D',  ///< wide slots for disabled drivers
  kSlanted = 'S',
  kParallel = 'L',
  kHatched = 'H',  ///< no parking
  kRoom = 'R',     ///< walled
  kOpen = 'O',     ///< bare floor
  kAisle = '|',    ///< a cross aisle goes through
};

/// A garage as a drawing in letters. Columns are cells between pillar lines along x; long aisles
/// run along x, cross aisles along y through the cells marked '|'. From the bottom wall up:
/// `bottom`, aisle, islands (a lower row facing the aisle below, an upper row facing the aisle
/// above) with aisles between them, aisle, `top`. `left` and `right` are rows along the outer cross
/// aisles, their bays between the pillar lines along y, from the bottom up.
struct LayoutGrid {
  struct Island {
    std::string lower;
    std::string upper;
  };
  std::string bottom;
  std::vector<Island> islands;
  std::string top;
  std::string left;
  std::string right;
  double bottom_depth = 5.3;
  double top_depth = 5.3;
  double left_depth = 4.0;
  double right_depth = 6.0;
  int entrance_aisle = -1;  ///< long aisle whose left end opens to the ramp, or -1
};

/// One bay of a row: a stretch of its front.
struct Bay {
  double start = 0.0;  ///< m along the row
  double length = 0.0;
  BayKind kind = BayKind::kOpen;
};

/// A row of bays along one side of an aisle. Its frame stands at the front with x along it and y
/// into the depth: a driver who faces the row sees x to the right.
struct Row {
  Frame2 front;
  double depth = 0.0;
  std::vector<Bay> bays;
};

/// A free strip for driving.
struct AisleStrip {
  Eigen::Vector2d a, b;  ///< ends of the centre line
  double width = 6.0;
  bool cross = false;  ///< along y
};

/// Where rows, rooms, aisles and pillar lines of a drawing lie.
struct Layout {
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  Eigen::Vector2d max = Eigen::Vector2d::Zero();
  std::vector<Row> rows;
  std::vector<Room> rooms;
  std::vector<AisleStrip> aisles;
  std::vector<double> pillar_x, pillar_y;
  std::vector<double> cross_x, long_y;  ///< centre lines
  std::vector<Entrance> entrances;
};

Layout placeLayout(const LayoutGrid& grid, const GarageStyle& style);

/// The drawing of the preset "paper" and one drawn from a seed.
LayoutGrid paperGrid();
LayoutGrid randomGrid(const GarageStyle& style, Random random);

/// Free length that a pillar takes out of a bay, m: the pillar, and the slot lines on both sides.
double pillarGap(const GarageStyle& style);

/// The bare garage: outline, rooms, aisles, pillars, slots (unnumbered, free). Slots that would
/// touch a pillar, a room, an aisle or another slot are left out.
void buildFromLayout(const Layout& layout, const GarageStyle& style, Garage& garage);

}  // namespace parkade::sim
