// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/mapping/objects/column_sight.hpp"
#include "parkade/types/level_view.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {

/// Whether a camera's own picture shows a sign of a class with its middle at p (levelled vehicle
/// frame, m). Its place may lie off by a quarter of a metre; what may hide a sign, or bear one on
/// another side (pillars, vehicles, people, other signs), says nothing.
ColumnSight signSight(const LevelView& view, const Eigen::Vector3d& p, SemanticClass sign);

}  // namespace parkade
