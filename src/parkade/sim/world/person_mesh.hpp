// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/sim/scene.hpp"

namespace parkade::sim {

/// How a person looks. Colours are linear RGB reflectances.
struct PersonLook {
  double height = 1.74;  ///< m
  double girth = 1.0;    ///< 1: slim
  Eigen::Vector3f skin{0.40F, 0.24F, 0.17F};
  Eigen::Vector3f hair{0.03F, 0.02F, 0.015F};
  Eigen::Vector3f top{0.10F, 0.14F, 0.30F};
  Eigen::Vector3f trousers{0.05F, 0.05F, 0.07F};
  Eigen::Vector3f shoes{0.02F, 0.02F, 0.02F};
  bool skirt_coat = false;  ///< a coat down to the knees
};

inline constexpr int kGaitPhases = 8;

/// Length of one gait cycle (two steps) of a person of a height, m.
double gaitCycleLength(double height);

/// Adds the materials, labelled pedestrian, and one mesh for each phase of walking to the scene;
/// the indices of the meshes. Phase p of kGaitPhases belongs to a walked distance of
/// p / kGaitPhases of gaitCycleLength(). A further mesh, the last, stands still. x forward, z up,
/// the origin on the ground below the hips.
std::vector<int> addPersonMeshes(Scene& scene, const PersonLook& look);

}  // namespace parkade::sim
