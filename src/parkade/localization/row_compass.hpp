// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct RowCompassOptions {
  bool enable = true;
  double window_m = 25.0;
  double spacing_m = 5.0;
  double reach_m = 7.5;
  double apart_m = 4.0;
  double scatter_m = 0.03;
  double search_deg = 0.8;
  double min_excess = 80.0;
  double min_contrast = 2.0;
  double sigma_deg = 0.021;
  double doubling_excess = 300.0;

  void visit(OptionVisitor& v) {
    v.field("enable", enable, "Read the heading off rows of lines seen along the way, too.");
    v.field("window_m", window_m, "m", "Way over which lines are gathered.", 5.0, 200.0);
    v.field("spacing_m", spacing_m, "m", "Way between two readings.", 0.5, 200.0);
    v.field("reach_m", reach_m, "m", "Ends of lines further from the car are left out.", 1.0, 50.0);
    v.field("apart_m", apart_m, "m", "Least distance of two points that tell a row's direction.",
            0.5, 50.0);
    v.field("scatter_m", scatter_m, "m", "How far points of a row lie off it, about.", 0.002, 0.5);
    v.field("search_deg", search_deg, "deg", "Rows farther off the expected axes are not found.",
            0.1, 10.0);
    v.field(
        "min_excess", min_excess, "count",
        "Pairs of points that a reading needs to lie along its direction, beyond those that lie "
        "along any; each counts for as much as it fits.",
        1.0, 1e6);
    v.field("min_contrast", min_contrast, "ratio",
            "Pairs along its direction that a reading needs for one along any other.", 1.0, 100.0);
    v.field("sigma_deg", sigma_deg, "deg",
            "Error of one reading from many points; it counts as many times, squared, as readings "
            "share a window, and what it differs by from the one before is added.",
            0.01, 10.0);
    v.field(
        "doubling_excess", doubling_excess, "count",
        "A reading from so many pairs beyond chance errs by twice as much, from a third of them "
        "by four times.",
        0.0, 1e6);
  }
};

/// A direction that rows run along or square to.
struct RowReading {
  double direction = 0.0;  ///< rad, in the odometry's frame, modulo 90 degrees
  double sigma = 0.0;      ///< rad; of readings taken for independent, which neighbours are not
};

/// Heading from whole rows: ends of slot lines, and points along lines, that were seen over tens of
/// metres of way lie on straight lines square or parallel to each other (entrances of a row, lanes,
/// stop lines). A row of 20 m tells its direction to some hundredths of a degree where a line of a
/// single picture errs by tenths, and short or worn lines, whose own direction is worth nothing,
/// count as well. docs/math/fusion.md, eq. (6).
class RowCompass {
 public:
  explicit RowCompass(const RowCompassOptions& options) : options_(options) {}

  /// Enters a frame's lines, seen where the odometry says (its frame must be smooth over the
  /// window; forget() where it was not), at this way travelled, m.
  void add(const SemanticFrame& frame, const SE2& T_odom_vehicle, double travelled_m);
  void forget() {
    seen_.clear();
    before_.reset();
  }

  /// The direction in the odometry's frame (rad, modulo 90 degrees, nearest to the expected one)
  /// that rows of the last metres run along or square to. Nothing where little more lies along one
  /// direction than along any, where the best direction is at the search's edge, and before
  /// spacing_m since the last reading. Neighbours see nearly the same lines: a reading is as unsure
  /// as it differs from the one before.
  std::optional<RowReading> read(double expected_direction);

 private:
  /// A point, or the way from one point to another, along a row and across it, m.
  struct AlongAcross {
    float along;
    float across;
  };
  struct Seen {
    double travelled_m;
    std::vector<Eigen::Vector2d> points;  // odometry's frame
  };
  struct Found {
    double travelled_m;
    double direction;  // odometry's frame
  };
  /// The ways between any two points that may lie on one row along about this direction.
  void appendPairs(double direction, std::vector<AlongAcross>& pairs) const;
  [[nodiscard]] double support(const std::vector<AlongAcross>& pairs, double turn) const;
  /// rad; how far a direction lies off the one found before, on nearly the same lines. The next one
  /// is compared with it.
  double offBefore(double direction);

  RowCompassOptions options_;
  std::deque<Seen> seen_;
  double last_read_m_ = -1e9;
  std::optional<Found> before_;
};

}  // namespace parkade
