// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/sim/render/embree.hpp"
#include "parkade/sim/render/render_mesh.hpp"

namespace parkade::sim {

/// Share of the light around that each vertex of an object gets while it stands on a floor: 1 free,
/// 0.1 where every direction meets the object itself or the floor below it. scene holds the mesh.
std::vector<float> opennessOf(const RenderMesh& mesh, RTCScene scene);

/// The same, with a tree that lives for the call only.
std::vector<float> opennessOf(const RenderMesh& mesh, RTCDevice device);

}  // namespace parkade::sim
