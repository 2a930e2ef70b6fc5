// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_views.hpp"

#include <utility>

#include "parkade/semantics/texts/zone_text_parting.hpp"

namespace parkade {
namespace {

Result<FaceReadings> readEach(const std::vector<ZoneMarkerFace>& faces, ZoneTextReader& reader,
                              const std::string& only) {
  FaceReadings read;
  for (const ZoneMarkerFace& face : faces) {
    Result<std::vector<TextReading>> readings = reader.read(face.patch, only);
    if (!readings) return readings.error();
    read.push_back(std::move(readings).value());
  }
  return read;
}

}  // namespace

Result<ReadMarker> readMarker(const ZoneMarkerSight& sight, ZoneTextReader& reader,
                              const std::string& only) {
  ReadMarker read;
  const std::vector<ZoneMarkerFace>* const faces[2] = {&sight.faces, &sight.other_faces};
  std::vector<FaceReadings> partings;
  std::vector<const std::vector<ZoneMarkerFace>*> parted;
  for (const std::vector<ZoneMarkerFace>* const part : faces) {
    if (part->empty()) continue;
    Result<FaceReadings> readings = readEach(*part, reader, only);
    if (!readings) return readings.error();
    partings.push_back(std::move(readings).value());
    parted.push_back(part);
    if (isSettled(partings.back())) break;
  }
  if (partings.empty()) return read;
  SightText told = tellText(partings);
  read.readings = std::move(told.readings);
  for (const ZoneMarkerFace& face : *parted[told.parting]) read.faces.push_back(&face);
  return read;
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
      Result<ReadMarker> read = readMarker(sight, *reader, only);
      if (!read) return read.error();
      if (!read->faces.empty()) view.readings.push_back(std::move(read->readings));
    }
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace parkade
