// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_views.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "parkade/semantics/texts/zone_text_parting.hpp"

namespace parkade {
namespace {

using Parted = std::vector<const std::vector<ZoneMarkerFace>*>;
using Looks = std::vector<std::vector<FaceLooks>>;

// Of faces where the outline says that they are.
Result<std::vector<FaceLooks>> lookAt(const std::vector<ZoneMarkerFace>& faces,
                                      ZoneTextReader& reader, const std::string& only) {
  std::vector<FaceLooks> looks;
  for (const ZoneMarkerFace& face : faces) {
    Result<SequenceLikelihood> letters = reader.look(face.patch, only);
    if (!letters) return letters.error();
    std::vector<TextReading> readings = ZoneTextReader::readingsOf(*letters);
    looks.push_back({{std::move(letters).value(), std::move(readings)}});
  }
  return looks;
}

// Adds what stands above and below faces: labels err in where a marker ends.
Status addAround(const std::vector<ZoneMarkerFace>& faces, ZoneTextReader& reader,
                 const std::string& only, std::vector<FaceLooks>& looks) {
  constexpr double kOdds = 0.8;  // of a step away, for each step
  constexpr int kSteps = (kTallPatchHeight - kZonePatchHeight) / kTallPatchStep / 2;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Result<std::vector<SequenceLikelihood>> around = reader.lookAround(faces[i].around, only);
    if (!around) return around.error();
    int step = -kSteps;
    for (const SequenceLikelihood& letters : *around) {
      if (step != 0) {
        looks[i].push_back({letters, ZoneTextReader::readingsOf(letters),
                            std::pow(kOdds, std::abs(step)), step * kTallPatchStep});
      }
      ++step;
    }
  }
  return {};
}

bool isOpen(const SightText& told) {
  constexpr double kSure = 0.5;
  return told.readings.front().text.empty() || told.readings.front().probability < kSure;
}

ZoneMarkerFace movedDown(ZoneMarkerFace face, int px) {
  const double share = px / face.patch_height;
  const Eigen::Vector2d left = face.corners[3] - face.corners[0];
  const Eigen::Vector2d right = face.corners[2] - face.corners[1];
  for (const std::size_t k : {0U, 3U}) face.corners[k] += share * left;
  for (const std::size_t k : {1U, 2U}) face.corners[k] += share * right;
  return face;
}

Result<ReadMarker> readSign(const ZoneMarkerSight& sight, ZoneTextReader& reader,
                            const std::string& only) {
  ReadMarker read;
  if (sight.faces.empty()) return read;
  Result<std::vector<TextReading>> readings = reader.read(sight.faces.front().patch, only);
  if (!readings) return readings.error();
  read.readings = std::move(readings).value();
  read.faces = {sight.faces.front()};
  return read;
}

}  // namespace

Result<ReadMarker> readMarker(const ZoneMarkerSight& sight, ZoneTextReader& reader,
                              const std::string& only) {
  if (sight.semantic_class != SemanticClass::kZoneMarker) return readSign(sight, reader, only);
  ReadMarker read;
  Parted parted;
  Looks partings;
  for (const std::vector<ZoneMarkerFace>* const faces : {&sight.faces, &sight.other_faces}) {
    if (faces->empty()) continue;
    Result<std::vector<FaceLooks>> looks = lookAt(*faces, reader, only);
    if (!looks) return looks.error();
    parted.push_back(faces);
    partings.push_back(std::move(looks).value());
    if (isSettled(partings.back())) break;
  }
  if (partings.empty()) return read;
  SightText told = tellText(partings);
  // Patches are read fastest where there are few; small ones seldom tell more.
  constexpr double kLeastHeight = 16.0;  // px
  const auto few = std::min_element(parted.begin(), parted.end(), [](const auto* a, const auto* b) {
    return a->size() < b->size();
  });
  if (isOpen(told) && (*few)->front().height_px >= kLeastHeight) {
    const auto k = static_cast<std::size_t>(few - parted.begin());
    const Status status = addAround(**few, reader, only, partings[k]);
    if (!status) return status.error();
    told = tellText(partings);
  }
  read.readings = std::move(told.readings);
  constexpr double kWhole = 0.8;  // of texts that a cut sight shows
  for (TextReading& reading : read.readings) {
    if (!sight.legible && !reading.text.empty()) reading.probability *= kWhole;
  }
  const std::vector<ZoneMarkerFace>& faces = *parted[told.parting];
  for (std::size_t i = 0; i < faces.size(); ++i) {
    read.faces.push_back(movedDown(faces[i], told.down[i]));
  }
  return read;
}

ZoneMarkerView viewOf(const ZoneMarkerSight& sight, const Eigen::Vector3d& eye) {
  return {eye, sight.ray_level, sight.sigma, sight.height_ratio, sight.height_sigma,
          {},  !sight.cut};
}

Result<std::vector<ZoneMarkerView>> viewsOf(const std::vector<ZoneMarkerSight>& sights,
                                            const Eigen::Vector3d& eye, ZoneTextReader* reader,
                                            const std::string& only) {
  std::vector<ZoneMarkerView> views;
  for (const ZoneMarkerSight& sight : sights) {
    const bool read_it = reader != nullptr && !sight.faces.empty();
    // Where the middle is not seen a view places nothing, but may be read.
    if (sight.cut && !read_it) continue;
    ZoneMarkerView view = viewOf(sight, eye);
    if (read_it) {
      Result<ReadMarker> read = readMarker(sight, *reader, only);
      if (!read) return read.error();
      if (!read->faces.empty()) view.readings.push_back(std::move(read->readings));
    }
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace parkade
