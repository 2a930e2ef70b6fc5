// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/sign_follower.hpp"

#include <utility>

namespace parkade {
SignFollower::SignFollower(const SignFollowerOptions& options)
    : options_(options), guides_(options.guide), limits_(options.limit) {}

Status SignFollower::add(const cv::Mat& labels, const cv::Mat& image, const cv::Mat& mask,
                         const Camera& camera, const SE3& T_up_cam, TimeNs t_ns,
                         ZoneTextReader& reader) {
  if (!options_.enabled) return {};
  for (const SemanticClass sign : {SemanticClass::kGuideSign, SemanticClass::kSpeedLimitSign}) {
    const bool limit = sign == SemanticClass::kSpeedLimitSign;
    std::vector<ZoneMarkerView> views;
    for (const ZoneMarkerSight& sight :
         findSigns(labels, image, mask, camera, T_up_cam.rotation(), sign, options_.faces)) {
      if (sight.cut) continue;
      ZoneMarkerView view{T_up_cam.translation(), sight.ray_level,    sight.sigma,
                          sight.height_ratio,     sight.height_sigma, {}};
      for (const ZoneMarkerFace& face : sight.faces) {
        if (!limit) break;
        Result<std::vector<TextReading>> readings = reader.read(face.patch, "0123456789");
        if (!readings) return readings.error();
        view.readings.push_back(std::move(readings).value());
      }
      views.push_back(std::move(view));
    }
    (limit ? limits_ : guides_).add(views, t_ns);
  }
  return {};
}

std::vector<FollowedSign> SignFollower::takeTold() {
  std::vector<FollowedSign> told;
  for (ZoneMarker& sign : guides_.takeTold()) {
    told.push_back({SemanticClass::kGuideSign, std::move(sign)});
  }
  for (ZoneMarker& sign : limits_.takeTold()) {
    if (sign.confidence < options_.text_confidence) sign.text.clear();
    told.push_back({SemanticClass::kSpeedLimitSign, std::move(sign)});
  }
  return told;
}

}  // namespace parkade
