// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct CompassOptions {
  bool enable = true;
  double min_length_m = 1.0;
  double paint_sigma_deg = 0.2;
  double window_deg = 3.0;
  double min_share = 0.5;
  double reference_m = 10.0;
  double reference_sigma_deg = 1.0;
  double sigma_deg = 0.15;

  void visit(OptionVisitor& v) {
    v.field("enable", enable, "Take the rows of a garage for parallel or square to each other.");
    v.field("min_length_m", min_length_m, "m", "Shorter pieces of line have no direction.", 0.1,
            20.0);
    v.field("paint_sigma_deg", paint_sigma_deg, "deg", "How straight and square lines are painted.",
            0.0, 5.0);
    v.field("window_deg", window_deg, "deg", "Lines farther off the garage's axes are others.", 0.1,
            20.0);
    v.field("min_share", min_share, "ratio",
            "Share of the lines in view that must lie along the axes.", 0.0, 1.0);
    v.field("reference_m", reference_m, "m", "Way over which the axes are learned.", 0.5, 100.0);
    v.field("reference_sigma_deg", reference_sigma_deg, "deg",
            "Error of the axes as learned, which all headings read off them share.", 0.001, 10.0);
    v.field("sigma_deg", sigma_deg, "deg",
            "Least error of one heading by the axes, once a metre: 1.3 times their scatter, for "
            "neighbours in time see the same lines; scattered readings err by more.",
            0.01, 10.0);
  }
};

/// Heading from the garage's axes: painted lines of a garage run along two square directions, which
/// the first metres of a drive show. Later frames read their heading off them, modulo 90 degrees.
/// Slanted lines are left out; where too many are, it says nothing. docs/math/fusion.md.
class Compass {
 public:
  explicit Compass(const CompassOptions& options) : options_(options) {}

  /// Enters a frame seen at the expected heading, at this way travelled. Gives the heading that the
  /// axes as learned tell, once they are known; nothing where too few lines lie along them. Lines
  /// are looked for about the axes turned by axis_shift: what is known by now of how wrong they
  /// were learned. A window about wrong axes would cut the lines' scatter on one side.
  std::optional<double> read(const SemanticFrame& frame, double expected_heading,
                             double travelled_m, double axis_shift = 0.0);

  /// The world is called otherwise from now on: turned by an angle (rad). Axes that are learned
  /// stay as they were, in the world of then (axis_shift of read() holds the turn).
  void turnWorld(double angle);

  /// The direction of the axes in the world as learned, modulo 90 degrees, once it is.
  [[nodiscard]] std::optional<double> axis() const {
    return learned_ ? std::optional<double>(axis_) : std::nullopt;
  }

 private:
  CompassOptions options_;
  bool learned_ = false;
  double begin_m_ = -1.0;
  double axis_ = 0.0;  // world direction, modulo 90 degrees
  struct Line {
    double direction = 0.0;  // rad, in the world while learning, else in the vehicle
    double weight = 0.0;
  };
  [[nodiscard]] std::vector<Line> linesOf(const SemanticFrame& frame) const;
  bool learnAxis();
  std::vector<Line> seen_;  // while learning
};

/// How much the headings that a compass reads err, told by how they differ from each other: over
/// the last metres the odometry does not turn by as much as readings of worn lines scatter. Such
/// err together over tens of metres, and are told with much more (docs/math/fusion.md, Axes).
class CompassScatter {
 public:
  /// usual_sigma: rad, the error of a reading where lines are good; none is told to be less.
  explicit CompassScatter(double usual_sigma) : usual_sigma_(usual_sigma) {}

  /// Enters a reading, less the odometry's heading (rad), and gives its sigma, rad. Nothing for the
  /// first ones: how much they scatter is not known, and one that errs by a degree told as a good
  /// one would turn the axes for good.
  std::optional<double> add(double off_odometry);
  void forget() { latest_.clear(); }

 private:
  double usual_sigma_;
  std::deque<double> latest_;
};

}  // namespace parkade
