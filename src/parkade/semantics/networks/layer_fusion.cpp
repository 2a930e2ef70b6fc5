// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/layer_fusion.hpp"

#include <algorithm>

namespace parkade {
namespace {

// How often a value is needed by the layers from that index on, the network's output counted.
int usesFrom(const NetworkGraph& graph, std::size_t index, int value) {
  int count = value == graph.output ? 1 : 0;
  for (std::size_t i = index; i < graph.layers.size(); ++i) {
    const std::vector<int>& inputs = graph.layers[i].inputs;
    count += static_cast<int>(std::count(inputs.begin(), inputs.end(), value));
  }
  return count;
}

// The layer behind those fused so far, if it is the only one to need what they make.
const NetworkLayer* nextLayer(const NetworkGraph& graph, std::size_t index,
                              const FusedLayers& fused) {
  const std::size_t next = index + 1 + fused.count;
  if (next >= graph.layers.size() || usesFrom(graph, next, fused.output) != 1) return nullptr;
  const std::vector<int>& inputs = graph.layers[next].inputs;
  const bool needs = std::find(inputs.begin(), inputs.end(), fused.output) != inputs.end();
  return needs ? &graph.layers[next] : nullptr;
}

}  // namespace

FusedLayers fuseFollowing(const NetworkGraph& graph, std::size_t index) {
  FusedLayers fused;
  fused.output = graph.layers[index].output;
  const NetworkLayer* layer = nextLayer(graph, index, fused);
  if (layer != nullptr && layer->kind == NetworkLayer::Kind::kSum) {
    const int other = layer->inputs[0] == fused.output ? layer->inputs[1] : layer->inputs[0];
    if (other > 0 && usesFrom(graph, index, other) == 1) {
      fused.sum = true;
      fused.added = other;
      fused.output = layer->output;
      ++fused.count;
      layer = nextLayer(graph, index, fused);
    }
  }
  if (layer != nullptr && layer->kind == NetworkLayer::Kind::kRelu) {
    fused.relu = true;
    fused.output = layer->output;
    ++fused.count;
  }
  return fused;
}

}  // namespace parkade
