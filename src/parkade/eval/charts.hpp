// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "parkade/eval/svg.hpp"

namespace parkade {

// Pictures of a report, as SVG documents of 480 pixels in width: readable on a phone, and twice
// side by side on a desk.

/// Something drawn with a name in the legend.
struct ChartLine {
  std::string name;
  svg::Points points;      ///< metres over the ground, or (x, y) of a function, x ascending
  bool reference = false;  ///< drawn wide and grey, below the others
};

/// A picture of the ground, x to the right and y up.
struct GroundPicture {
  std::string address;                                 ///< data: URI
  Eigen::Vector2d top_left = Eigen::Vector2d::Zero();  ///< its upper left edge, m
  Eigen::Vector2d size = Eigen::Vector2d::Ones();      ///< m
  bool whole = false;  ///< the view is the picture, wherever the ways are
};

struct GroundLabel {
  std::string text;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
};

/// Ways over the ground with equal axes, on a picture of it where there is one. The view holds the
/// ways with some metres around; the whole picture where there is no way.
std::string groundChart(const std::string& title, const std::optional<GroundPicture>& picture,
                        const std::vector<ChartLine>& lines,
                        const std::vector<GroundLabel>& labels = {});

/// Functions over one axis, y from 0.
std::string lineChart(const std::string& title, const std::string& x_name,
                      const std::vector<ChartLine>& lines);

struct ChartBar {
  std::string name;
  double value = 0.0;
  double mark = -1.0;  ///< a second value as a thin line; below 0: none
  std::string text;    ///< behind the bar
};

/// Bars from 0, lying.
std::string barChart(const std::string& title, const std::vector<ChartBar>& bars);

}  // namespace parkade
