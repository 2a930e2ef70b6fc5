// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/sign_follower.hpp"

#include <string>
#include <utility>

#include "parkade/core/split.hpp"
#include "parkade/semantics/texts/guide_text.hpp"
#include "parkade/semantics/texts/zone_marker_views.hpp"

namespace parkade {
SignFollower::SignFollower(const SignFollowerOptions& options)
    : options_(options),
      guides_(options.guide),
      limits_(options.limit),
      limit_texts_(split(options.limits, ' ')) {
  limit_texts_.emplace_back();
}

Status SignFollower::add(const cv::Mat& labels, const cv::Mat& image, const cv::Mat& mask,
                         const Camera& camera, const SE3& T_up_cam, TimeNs t_ns,
                         ZoneTextReader& reader) {
  if (!options_.enabled) return {};
  // A reader that was never taught arrows would read words of signs wrong.
  const bool knows_arrows = reader.letters().find('^') != std::string::npos;
  for (const SemanticClass sign : {SemanticClass::kGuideSign, SemanticClass::kSpeedLimitSign}) {
    const bool limit = sign == SemanticClass::kSpeedLimitSign;
    Result<std::vector<ZoneMarkerView>> views =
        viewsOf(findSigns(labels, image, mask, camera, T_up_cam.rotation(), sign, options_.faces),
                T_up_cam.translation(), limit || knows_arrows ? &reader : nullptr,
                limit ? "0123456789" : kGuideLetters);
    if (!views) return views.error();
    for (ZoneMarkerView& view : *views) {
      for (auto& face : view.readings) {
        if (limit) keepTexts(limit_texts_, face);
      }
    }
    (limit ? limits_ : guides_).add(*views, t_ns);
  }
  return {};
}

std::vector<FollowedSign> SignFollower::takeTold() {
  std::vector<FollowedSign> told;
  const auto take = [&](SemanticClass semantic_class, ZoneMarkerTracker& tracker) {
    for (ZoneMarker& sign : tracker.takeTold()) {
      if (sign.confidence < options_.text_confidence) sign.text.clear();
      if (semantic_class == SemanticClass::kGuideSign) sign.text = guideMeaning(sign.text);
      told.push_back({semantic_class, std::move(sign)});
    }
  };
  take(SemanticClass::kGuideSign, guides_);
  take(SemanticClass::kSpeedLimitSign, limits_);
  return told;
}

}  // namespace parkade
