// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/geometry/se3.hpp"

namespace parkade {

/// Why an alignment leaves some of its freedom open.
enum class Degeneracy {
  kNone,
  kTooFewPoints,  ///< fewer points than the method needs (3; yaw and origin: 1)
  kCoincident,    ///< all points at one place (yaw: above one another): no rotation, no scale
  kCollinear,     ///< all points on one line, as far as they agree: the rotation about it is open
};

/// "none", "too few points", "all points at one place", "all points on one line".
const char* toString(Degeneracy degeneracy);

/// A map from source to target: p_target = T_target_source * (scale * p_source). What the points
/// leave open (see degeneracy) is filled by the smallest rotation and by scale 1; the residual is
/// least all the same.
struct Alignment {
  SE3 T_target_source;
  double scale = 1.0;  ///< target length per source length; 1 but for alignSim3
  Degeneracy degeneracy = Degeneracy::kNone;
  double rmse = 0.0;  ///< of the points after the alignment, in the target's unit

  [[nodiscard]] bool degenerate() const { return degeneracy != Degeneracy::kNone; }
  /// A point, or a pose T_source_body, in the target frame.
  Eigen::Vector3d operator*(const Eigen::Vector3d& p_source) const {
    return T_target_source * Eigen::Vector3d(scale * p_source);
  }
  SE3 operator*(const SE3& T_source_body) const {
    return {T_target_source.rotation() * T_source_body.rotation(),
            *this * T_source_body.translation()};
  }
};

using Points3d = std::vector<Eigen::Vector3d>;

/// The rigid motion with the least sum of squared distances between target[i] and T * source[i].
/// Umeyama, "Least-squares estimation of transformation parameters between two point patterns",
/// PAMI 1991, eqs. (40) to (43), never a reflection; derivation in docs/math/alignment.md. Both
/// lists have the same length (checked); an empty pair gives the identity.
Alignment alignSE3(const Points3d& source, const Points3d& target);

/// As alignSE3, with a free scale (> 0).
Alignment alignSim3(const Points3d& source, const Points3d& target);

/// As alignSE3, but only the translation and the rotation about the z axis are free: for two frames
/// whose z axes point up already, as gravity shows them (4 degrees of freedom). Closed form.
Alignment alignYaw(const Points3d& source, const Points3d& target);

/// The rigid motion that puts one pose onto another.
Alignment alignOrigin(const SE3& T_source_body, const SE3& T_target_body);

}  // namespace parkade
