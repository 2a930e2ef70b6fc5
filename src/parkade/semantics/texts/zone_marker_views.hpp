// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/semantics/texts/zone_marker_faces.hpp"
#include "parkade/semantics/texts/zone_marker_tracker.hpp"
#include "parkade/semantics/texts/zone_text_reader.hpp"

namespace parkade {

/// A marker, or a sign, and what is written on it.
struct ReadMarker {
  /// The sight's that show it, their corners where it was read; none: nothing was read.
  std::vector<ZoneMarkerFace> faces;
  std::vector<TextReading> readings;  ///< best first, by all that is read of it
};

/// Reads a sight's faces, from the characters `only` (empty: all). Where that leaves a question and
/// a zone marker's outline could be parted otherwise, those faces are read too, and then what
/// stands a little above and below them (zone_text_parting.hpp). Fails as the reader does.
Result<ReadMarker> readMarker(const ZoneMarkerSight& sight, ZoneTextReader& reader,
                              const std::string& only = {});

/// What one camera's sights say to the tracker: those seen whole, from the camera's place `eye` in
/// the axes of their rays. `reader` reads their faces, from the characters `only` (empty: all);
/// without a reader nothing is read, nor what `known` (empty: nothing) says need not be. Fails as
/// the reader does.
Result<std::vector<ZoneMarkerView>> viewsOf(
    const std::vector<ZoneMarkerSight>& sights, const Eigen::Vector3d& eye, ZoneTextReader* reader,
    const std::string& only = {},
    const std::function<bool(const ZoneMarkerView&)>& known = nullptr);

}  // namespace parkade
