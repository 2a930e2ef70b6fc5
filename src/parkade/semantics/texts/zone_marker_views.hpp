// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
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

/// What a sight says to the tracker before it is read. eye: the camera's place in the axes of the
/// sight's ray.
ZoneMarkerView viewOf(const ZoneMarkerSight& sight, const Eigen::Vector3d& eye);

/// What one camera's sights say to the tracker: those seen whole, and those that are read. `reader`
/// reads their faces, from the characters `only` (empty: all); without one nothing is read. Fails
/// as the reader does.
Result<std::vector<ZoneMarkerView>> viewsOf(const std::vector<ZoneMarkerSight>& sights,
                                            const Eigen::Vector3d& eye, ZoneTextReader* reader,
                                            const std::string& only = {});

}  // namespace parkade
