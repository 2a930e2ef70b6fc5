// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/network_graph.hpp"

#include <onnx/onnx_pb.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>

namespace parkade {
namespace {

static_assert(std::endian::native == std::endian::little, "ONNX's raw numbers are little-endian");

struct Unsupported {};

void require(bool condition) {
  if (!condition) throw Unsupported{};
}

std::vector<float> floatsOf(const onnx::TensorProto& tensor) {
  require(tensor.data_type() == onnx::TensorProto::FLOAT &&
          tensor.data_location() == onnx::TensorProto::DEFAULT);
  std::size_t count = 1;
  for (const auto size : tensor.dims()) count *= static_cast<std::size_t>(size);
  std::vector<float> numbers(tensor.float_data().begin(), tensor.float_data().end());
  if (tensor.has_raw_data()) {
    require(tensor.raw_data().size() == count * sizeof(float));
    numbers.resize(count);
    std::memcpy(numbers.data(), tensor.raw_data().data(), tensor.raw_data().size());
  }
  require(numbers.size() == count);
  return numbers;
}

/// Turns nodes into layers, one after the other.
class GraphReader {
 public:
  explicit GraphReader(const onnx::GraphProto& graph) : graph_(graph) {
    for (const auto& tensor : graph.initializer()) constants_[tensor.name()] = &tensor;
  }

  NetworkGraph read() {
    require(graph_.output_size() == 1);
    for (const auto& input : graph_.input()) {  // old files name their weights here, too
      if (constants_.count(input.name()) == 0) require(values_.emplace(input.name(), 0).second);
    }
    require(values_.size() == 1);
    for (const auto& node : graph_.node()) add(node);
    const auto output = values_.find(graph_.output(0).name());
    require(output != values_.end() && output->second > 0);
    result_.output = output->second;
    return std::move(result_);
  }

 private:
  const onnx::AttributeProto* attribute(const onnx::NodeProto& node,
                                        const std::string& name) const {
    for (const auto& each : node.attribute()) {
      if (each.name() == name) return &each;
    }
    return nullptr;
  }
  std::string text(const onnx::NodeProto& node, const std::string& name,
                   const std::string& otherwise) const {
    const auto* const found = attribute(node, name);
    return found != nullptr ? found->s() : otherwise;
  }
  // `offset`: of the pair within the list.
  std::array<int, 2> pair(const onnx::NodeProto& node, const std::string& name, int otherwise,
                          int offset = 0, int length = 2) const {
    const auto* const found = attribute(node, name);
    if (found == nullptr) return {otherwise, otherwise};
    require(found->ints_size() == length);
    return {static_cast<int>(found->ints(offset)), static_cast<int>(found->ints(offset + 1))};
  }
  const onnx::TensorProto& constant(const std::string& name) const {
    const auto found = constants_.find(name);
    require(found != constants_.end());
    return *found->second;
  }
  int value(const onnx::NodeProto& node, int input) const {
    require(input < node.input_size());
    const auto found = values_.find(node.input(input));
    require(found != values_.end());
    return found->second;
  }

  void readWindow(const onnx::NodeProto& node, NetworkLayer& layer) const {
    layer.stride = pair(node, "strides", 1);
    layer.pad_before = pair(node, "pads", 0, 0, 4);
    layer.pad_after = pair(node, "pads", 0, 2, 4);
    layer.dilation = pair(node, "dilations", 1);
    require(text(node, "auto_pad", "NOTSET") == "NOTSET");
    for (std::size_t i = 0; i < 2; ++i) {
      require(layer.stride[i] > 0 && layer.dilation[i] > 0);
      require(layer.pad_before[i] >= 0 && layer.pad_after[i] >= 0);
    }
  }

  void readConvolution(const onnx::NodeProto& node, NetworkLayer& layer) const {
    layer.kind = NetworkLayer::Kind::kConvolution;
    readWindow(node, layer);
    const auto* const group = attribute(node, "group");
    require(group == nullptr || group->i() == 1);
    require(node.input_size() >= 2);
    const onnx::TensorProto& weights = constant(node.input(1));
    require(weights.dims_size() == 4);
    layer.channels = {static_cast<int>(weights.dims(0)), static_cast<int>(weights.dims(1))};
    layer.kernel = {static_cast<int>(weights.dims(2)), static_cast<int>(weights.dims(3))};
    layer.weights = floatsOf(weights);
    layer.bias.assign(static_cast<std::size_t>(layer.channels[0]), 0.0F);
    if (node.input_size() > 2) layer.bias = floatsOf(constant(node.input(2)));
    require(layer.bias.size() == static_cast<std::size_t>(layer.channels[0]));
  }

  void readMaxPool(const onnx::NodeProto& node, NetworkLayer& layer) const {
    layer.kind = NetworkLayer::Kind::kMaxPool;
    readWindow(node, layer);
    layer.kernel = pair(node, "kernel_shape", 1);
    const auto* const ceil = attribute(node, "ceil_mode");
    require(ceil == nullptr || ceil->i() == 0);
    require(layer.dilation[0] == 1 && layer.dilation[1] == 1 && node.output_size() == 1);
  }

  // Inputs: picture, region (not used), factors of all four dimensions.
  void readEnlarge(const onnx::NodeProto& node, NetworkLayer& layer) const {
    layer.kind = NetworkLayer::Kind::kEnlarge;
    require(text(node, "mode", "nearest") == "linear");
    const std::string mode = text(node, "coordinate_transformation_mode", "half_pixel");
    require(mode == "half_pixel" || mode == "pytorch_half_pixel");
    require(node.input_size() == 3);
    const std::vector<float> factors = floatsOf(constant(node.input(2)));
    require(factors.size() == 4 && factors[0] == 1.0F && factors[1] == 1.0F);
    for (std::size_t i = 0; i < 2; ++i) {
      const float factor = factors[2 + i];
      require(factor >= 1.0F && factor == std::floor(factor));
      layer.factor[i] = static_cast<int>(factor);
    }
  }

  void add(const onnx::NodeProto& node) {
    if (node.op_type() == "Constant") {
      const auto* const found = attribute(node, "value");
      require(found != nullptr && found->has_t() && node.output_size() == 1);
      constants_[node.output(0)] = &found->t();
      return;
    }
    NetworkLayer layer;
    layer.inputs.push_back(value(node, 0));
    if (node.op_type() == "Conv") {
      readConvolution(node, layer);
    } else if (node.op_type() == "Relu") {
      layer.kind = NetworkLayer::Kind::kRelu;
    } else if (node.op_type() == "Add") {
      layer.kind = NetworkLayer::Kind::kSum;
      layer.inputs.push_back(value(node, 1));
    } else if (node.op_type() == "MaxPool") {
      readMaxPool(node, layer);
    } else if (node.op_type() == "Resize") {
      readEnlarge(node, layer);
    } else {
      throw Unsupported{};
    }
    layer.output = result_.values++;
    values_[node.output(0)] = layer.output;
    result_.layers.push_back(std::move(layer));
  }

  const onnx::GraphProto& graph_;
  std::map<std::string, const onnx::TensorProto*> constants_;
  std::map<std::string, int> values_;
  NetworkGraph result_;
};

}  // namespace

std::optional<NetworkGraph> readNetworkGraph(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  onnx::ModelProto model;
  if (!file || !model.ParseFromIstream(&file)) return std::nullopt;
  try {
    return GraphReader(model.graph()).read();
  } catch (const Unsupported&) {
    return std::nullopt;
  }
}

}  // namespace parkade
