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

std::vector<ReadFace> together(const std::vector<ZoneMarkerFace>& faces,
                               const FaceReadings& readings) {
  std::vector<ReadFace> read;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    read.push_back({&faces[i], onceEach(readings[i])});
  }
  return read;
}

}  // namespace

Result<std::vector<ReadFace>> readFaces(const ZoneMarkerSight& sight, ZoneTextReader& reader,
                                        const std::string& only) {
  Result<FaceReadings> first = readEach(sight.faces, reader, only);
  if (!first) return first.error();
  if (sight.other_faces.empty() || isSettled(*first, sight.one_face)) {
    return together(sight.faces, *first);
  }
  Result<FaceReadings> other = readEach(sight.other_faces, reader, only);
  if (!other) return other.error();
  const bool one =
      sight.one_face ? showsOneFace(*first, *other, true) : showsOneFace(*other, *first, false);
  return one == sight.one_face ? together(sight.faces, *first)
                               : together(sight.other_faces, *other);
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
