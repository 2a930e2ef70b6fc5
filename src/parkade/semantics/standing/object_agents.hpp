// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/semantics/standing/object_boxes.hpp"
#include "parkade/semantics/standing/object_contacts.hpp"

namespace parkade {

struct AgentOptions {
  int min_confidence = 100;
  int min_pixels = 4;
  double body_clearance_m = 0.2;
  double notch_m = 0.14;
  double sigma_px = 1.5;

  void visit(OptionVisitor& v) {
    v.field("min_confidence", min_confidence, "of 255", "Less sure pixels are left out.", 0, 255);
    v.field("min_pixels", min_pixels, "px", "Shorter edges at the floor are left out.", 1, 1000);
    v.field("body_clearance_m", body_clearance_m, "m",
            "Height of a car body's lower edge over the floor.", 0.0, 1.0);
    v.field("notch_m", notch_m, "m", "Edges with a narrow gap this deep belong to two cars.", 0.05,
            2.0);
    v.field("sigma_px", sigma_px, "px", "Error of an edge at the floor.", 0.01, 10.0);
  }
};

/// A vehicle or a person in one picture.
struct AgentDetection {
  SemanticClass semantic_class = SemanticClass::kVehicle;
  /// A vehicle's point nearest to the own car's middle; between a person's feet.
  Eigen::Vector2d contact = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< m^2, of contact
  Eigen::Vector2d viewer = Eigen::Vector2d::Zero();      ///< ground point under its camera
  GroundBox box;            ///< as far as its faces are seen; what is hidden is not in it
  bool cut = false;         ///< goes on where the picture ends or behind other things
  double confidence = 0.0;  ///< 0 to 1
};

/// Vehicles and people from where they meet the floor. A car body's lower edge is not on the floor
/// but over it and so looks farther away than it is; all of a car but its wheels is brought nearer
/// by that. Cars side by side are told apart by the gap between them, or by the slots (of the same
/// picture; may be empty) that they stand in.
std::vector<AgentDetection> findAgents(const ContactFinder& finder, const BevLabels& labels,
                                       const std::vector<SlotObservation>& slots,
                                       const BevViews& views, double attitude_sigma,
                                       const AgentOptions& options);

}  // namespace parkade
