// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/zone_text_samples.hpp"

#include <fmt/core.h>

#include <cmath>

#include "parkade/cli/zone_text_truth.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/semantics/zone_marker_faces.hpp"
#include "parkade/types/level_frame.hpp"

namespace parkade::cli {

Status writeZoneTexts(const SemanticSampler& sampler, const SemanticSample& sample, int camera,
                      const cv::Mat& labels, const std::string& stem) {
  constexpr double kReach = 40.0;     // m
  constexpr double kReadable = 0.85;  // of a text's area
  constexpr double kHidden = 0.3;
  const auto index = static_cast<std::size_t>(camera);
  const RigCamera& eye = sampler.simulation().toldRig().cameras[index];
  const SO3 R_level_vehicle = levelFrom(sample.attitude).rotation();
  ZoneMarkerFaceOptions options;
  options.min_height_px = 8.0;
  options.max_faces = 12;
  const std::vector<TrueZoneText> texts = trueZoneTexts(sampler, sample, camera, labels, kReach);
  cv::Mat patches(0, kZonePatchWidth, CV_8UC3);
  std::string lines = "text,height_px,slant_deg,distance_m\n";
  for (const ZoneMarkerSight& sight :
       findZoneMarkers(atNetworkSize(labels), sample.frames.images[index], sampler.bodyMask(camera),
                       eye.camera, R_level_vehicle * eye.T_vehicle_cam.rotation(), options)) {
    for (const ZoneMarkerFace& face : sight.faces) {
      const TrueZoneText* truth = textWithin(texts, face.corners);
      const bool readable = truth != nullptr && truth->in_sight >= kReadable;
      if (truth != nullptr && !readable && truth->in_sight >= kHidden) continue;
      patches.push_back(face.patch);
      lines += fmt::format("{},{:.1f},{:.1f},{:.2f}\n", readable ? truth->text : "", face.height_px,
                           face.slant * 180.0 / M_PI, readable ? truth->distance : 0.0);
    }
  }
  if (patches.rows == 0) return {};
  const Status status = writeFileAtomic(stem + "_texts.csv", lines);
  return status ? writeImage(stem + "_texts.png", patches, {.png = true}) : status;
}

}  // namespace parkade::cli
