// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/zone_marker_views.hpp"

#include <utility>

namespace parkade {

Result<std::vector<ZoneMarkerView>> viewsOf(const std::vector<ZoneMarkerSight>& sights,
                                            const Eigen::Vector3d& eye, ZoneTextReader* reader,
                                            const std::string& only) {
  std::vector<ZoneMarkerView> views;
  for (const ZoneMarkerSight& sight : sights) {
    // Where the middle is not seen a view places nothing, but may be read.
    if (sight.cut && (reader == nullptr || sight.faces.empty())) continue;
    ZoneMarkerView view{eye, sight.ray_level, sight.sigma, sight.height_ratio, sight.height_sigma,
                        {},  !sight.cut};
    for (const ZoneMarkerFace& face : sight.faces) {
      if (reader == nullptr) break;
      Result<std::vector<TextReading>> readings = reader->read(face.patch, only);
      if (!readings) return readings.error();
      view.readings.push_back(std::move(readings).value());
    }
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace parkade
