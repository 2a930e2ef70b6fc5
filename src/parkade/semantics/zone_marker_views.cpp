// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/zone_marker_views.hpp"

#include <algorithm>
#include <utility>

namespace parkade {
namespace {

Result<std::vector<ReadFace>> readEach(const std::vector<ZoneMarkerFace>& faces,
                                       ZoneTextReader& reader, const std::string& only) {
  std::vector<ReadFace> read;
  for (const ZoneMarkerFace& face : faces) {
    Result<std::vector<TextReading>> readings = reader.read(face.patch, only);
    if (!readings) return readings.error();
    read.push_back({&face, std::move(readings).value()});
  }
  return read;
}

// Probability of the surest face's text.
double certainty(const std::vector<ReadFace>& faces) {
  double best = 0.0;
  for (const ReadFace& face : faces) best = std::max(best, certaintyOf(face.readings));
  return best;
}

}  // namespace

Result<std::vector<ReadFace>> readFaces(const ZoneMarkerSight& sight, ZoneTextReader& reader,
                                        const std::string& only) {
  constexpr double kSure = 0.9;
  Result<std::vector<ReadFace>> first = readEach(sight.faces, reader, only);
  if (!first || sight.other_faces.empty() || certainty(*first) >= kSure) return first;
  Result<std::vector<ReadFace>> other = readEach(sight.other_faces, reader, only);
  return !other || certainty(*other) > certainty(*first) ? other : first;
}

Result<std::vector<ZoneMarkerView>> viewsOf(const std::vector<ZoneMarkerSight>& sights,
                                            const Eigen::Vector3d& eye, ZoneTextReader* reader,
                                            const std::string& only) {
  std::vector<ZoneMarkerView> views;
  for (const ZoneMarkerSight& sight : sights) {
    // Where the middle is not seen a view places nothing, but may be read.
    if (sight.cut && (reader == nullptr || sight.faces.empty())) continue;
    ZoneMarkerView view{eye, sight.ray_level, sight.sigma, sight.height_ratio, sight.height_sigma,
                        {},  !sight.cut};
    if (reader != nullptr) {
      Result<std::vector<ReadFace>> faces = readFaces(sight, *reader, only);
      if (!faces) return faces.error();
      for (ReadFace& face : *faces) view.readings.push_back(std::move(face.readings));
    }
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace parkade
