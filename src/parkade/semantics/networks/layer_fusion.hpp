// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "parkade/semantics/networks/network_graph.hpp"

namespace parkade {

/// The layers that follow a layer and are done with it, while its numbers are at hand: the sum with
/// another value, written over that value, and a rectifier.
struct FusedLayers {
  bool sum = false;
  int added = 0;  ///< the value that it is added to
  bool relu = false;
  int output = 0;         ///< the value that the last of them makes
  std::size_t count = 0;  ///< how many they are
};

/// What may be done with layer `index`: only layers right behind it whose other inputs are known by
/// then, and a sum only with a value that nothing needs afterwards and that is not the picture.
FusedLayers fuseFollowing(const NetworkGraph& graph, std::size_t index);

}  // namespace parkade
