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

/// A face and what is written on it, best first.
struct ReadFace {
  const ZoneMarkerFace* face = nullptr;  ///< of the sight
  std::vector<TextReading> readings;
};

/// Reads a sight's faces, from the characters `only` (empty: all). Where that leaves a question and
/// its outline could be parted otherwise, those faces are read too, and what is read decides
/// (zone_text_parting.hpp). Fails as the reader does.
Result<std::vector<ReadFace>> readFaces(const ZoneMarkerSight& sight, ZoneTextReader& reader,
                                        const std::string& only = {});

/// What one camera's sights say to the tracker: those seen whole, from the camera's place `eye` in
/// the axes of their rays. `reader` reads their faces, from the characters `only` (empty: all);
/// without a reader nothing is read. Fails as the reader does.
Result<std::vector<ZoneMarkerView>> viewsOf(const std::vector<ZoneMarkerSight>& sights,
                                            const Eigen::Vector3d& eye, ZoneTextReader* reader,
                                            const std::string& only = {});

}  // namespace parkade
