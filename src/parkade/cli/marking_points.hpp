// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"

namespace parkade::cli {

struct MarkingPointOptions {
  std::string folder;       ///< pictures, and annotations.txt
  std::string bev_network;  ///< class map; empty: Parkade's own
  std::string out;          ///< folder of metrics.json
  bool pictures = false;    ///< draw found and true points to out/pictures
  double width_m = 10.0;    ///< of the ground that a picture shows
  double radius_px = 10.0;  ///< a point found nearer than this to a true one is right
};

/// Scores the corners of slots, and the places where slot lines meet in a T or an L, on bird's-eye
/// pictures that others stitched and marked, as PS2.0: annotations.txt has a line per picture, NAME
/// x0,y0,x1,y1,class ..., where the middle of a box of class 0 is a marking point; other classes
/// are left out. Pictures are brought to the network's metres per pixel first. Prints the table and
/// writes metrics.json. Fails with the file and line that cannot be read.
Status scoreMarkingPoints(const MarkingPointOptions& options);

}  // namespace parkade::cli
