// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/zone_marker_views.hpp"

#include <utility>

#include "parkade/semantics/zone_text_parting.hpp"

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

FaceReadings readingsOf(const std::vector<ReadFace>& faces) {
  FaceReadings readings;
  for (const ReadFace& face : faces) readings.push_back(face.readings);
  return readings;
}

}  // namespace

Result<std::vector<ReadFace>> readFaces(const ZoneMarkerSight& sight, ZoneTextReader& reader,
                                        const std::string& only) {
  Result<std::vector<ReadFace>> first = readEach(sight.faces, reader, only);
  if (!first || sight.other_faces.empty()) return first;
  const FaceReadings likelier = readingsOf(*first);
  if (isSettled(likelier, sight.one_face)) return first;
  Result<std::vector<ReadFace>> second = readEach(sight.other_faces, reader, only);
  if (!second) return second;
  const FaceReadings other = readingsOf(*second);
  const bool one =
      sight.one_face ? showsOneFace(likelier, other, true) : showsOneFace(other, likelier, false);
  return one == sight.one_face ? first : second;
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
