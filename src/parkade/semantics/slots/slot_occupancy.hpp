// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "parkade/semantics/bev_views.hpp"
#include "parkade/semantics/label_probe.hpp"

namespace parkade {

/// Probability that a slot is free, from the labels of one picture. Where floor is seen in its
/// middle no car stands, except where a camera sees it below a parked car: a vehicle begins just
/// behind it. A vehicle speaks for a car in the slot where its foot, seen from the camera, lies in
/// the slot, and for nothing where it is the smear of one that stands before it; it speaks for
/// neither where two cameras' parts fade into each other and only one of them sees it so. 0.5 where
/// nothing of the middle is seen. corners: as in SlotObservation.
double probabilityFree(const LabelProbe& probe, const BevViews& views,
                       const std::array<Eigen::Vector2d, 4>& corners);

/// Share of a slot's middle whose sight lines come in over its entrance; the others cross another
/// slot's ground. docs/math/slots.md.
double shareSeenOverEntrance(const BevGeometry& geometry, const BevViews& views,
                             const std::array<Eigen::Vector2d, 4>& corners);

}  // namespace parkade
