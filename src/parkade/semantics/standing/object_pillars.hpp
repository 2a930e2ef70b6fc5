// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/semantics/standing/object_contacts.hpp"

namespace parkade {

struct PillarOptions {
  int min_confidence = 100;
  int min_pixels = 5;
  double min_size_m = 0.25;
  double max_size_m = 1.3;
  double sigma_px = 1.0;

  void visit(OptionVisitor& v) {
    v.field("min_confidence", min_confidence, "of 255", "Less sure pixels are left out.", 0, 255);
    v.field("min_pixels", min_pixels, "px", "Shorter edges at the floor are left out.", 1, 1000);
    v.field("min_size_m", min_size_m, "m", "Narrower things are no pillars.", 0.05, 5.0);
    v.field("max_size_m", max_size_m, "m", "Wider things are no pillars but walls.", 0.1, 5.0);
    v.field("sigma_px", sigma_px, "px", "Error of an edge at the floor.", 0.01, 10.0);
  }
};

/// Pillars, from where they meet the floor. position: the middle of a square (outline) on the faces
/// that are seen; where only one face is, its depth is taken as its width and the covariance says
/// that this is a guess. No heading: a square has four.
std::vector<ObjectObservation> findPillars(const ContactFinder& finder, const BevLabels& labels,
                                           const BevViews& views, double attitude_sigma,
                                           const PillarOptions& options);

}  // namespace parkade
