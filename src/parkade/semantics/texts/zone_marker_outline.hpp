// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace parkade {

/// One column of a marker's outline in the picture of a level camera that looks at it: x to the
/// right, v up, both over the depth.
struct MarkerColumn {
  double x = 0.0;
  double bottom = 0.0;
  double top = 0.0;
};

/// A vertical face between two columns; depths at both, in units of the marker's height.
struct FittedFace {
  double x_left = 0.0;
  double x_right = 0.0;
  double depth_left = 0.0;
  double depth_right = 0.0;
  /// In units of the marker's height.
  [[nodiscard]] double width() const;
  /// rad, between its normal and the line of sight to its middle.
  [[nodiscard]] double slant() const;
};

struct FittedMarker {
  std::vector<FittedFace> faces;  ///< one, or two that meet at the pillar's edge; left to right
  /// Those of the other model, where it can be: labels' outlines are not as exact as their pixels.
  std::vector<FittedFace> other_faces;
  double middle = 0.0;            ///< height of its middle over the camera, in marker heights
  double height_at_middle = 0.0;  ///< h at the outline's middle column
};

/// Fits one vertical face, or the two faces of a pillar with right angles, to an outline: whichever
/// explains it better. sigma: of a column's height. At least one column (checked); columns in
/// ascending order of x. corners: whether it may have two faces. docs/math/zone_markers.md.
FittedMarker fitMarker(const std::vector<MarkerColumn>& columns, double x_left, double x_right,
                       double sigma, bool corners = true);

}  // namespace parkade
