// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/compiled_network.hpp"

#include <omp.h>

#include <algorithm>
#include <dnnl.hpp>
#include <map>
#include <unordered_map>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/semantics/networks/layer_fusion.hpp"

namespace parkade {
namespace {

using dnnl::memory;
using Tag = memory::format_tag;
using Arguments = std::unordered_map<int, memory>;

constexpr auto kFloat = memory::data_type::f32;

memory::dims dims(const std::array<int, 2>& pair) {
  return {pair[0], pair[1]};
}

// The size of a value as a layer's kernel passes over it.
memory::dims windows(memory::dims size, const NetworkLayer& layer) {
  for (std::size_t i = 0; i < 2; ++i) {
    const int extent = (layer.kernel[i] - 1) * layer.dilation[i] + 1;
    size[2 + i] =
        (size[2 + i] + layer.pad_before[i] + layer.pad_after[i] - extent) / layer.stride[i] + 1;
  }
  return size;
}

memory::desc anyLayout(const memory::dims& size) {
  return {size, kFloat, Tag::any};
}

void requireSameSize(const memory::dims& a, const memory::dims& b) {
  if (a != b) throw dnnl::error(dnnl_invalid_arguments, "values of different sizes are added");
}

dnnl::primitive_attr attributesOf(const FusedLayers& fused = {}) {
  dnnl::post_ops after;
  if (fused.sum) after.append_sum(1.0F);
  if (fused.relu) after.append_eltwise(1.0F, dnnl::algorithm::eltwise_relu, 0.0F, 0.0F);
  dnnl::primitive_attr attributes;
  attributes.set_post_ops(after);
  // The library's own belongs to the thread that compiles; another one may run the network.
  attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
  return attributes;
}

// oneDNN takes as many threads as OpenMP gives to the calling thread.
class OneThread {
 public:
  OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

/// A layer graph compiled for pictures of one size.
struct Plan {
  struct Step {
    dnnl::primitive primitive;
    Arguments arguments;
  };
  std::vector<Step> steps;
  memory picture;
  memory output;
  cv::Mat result;
};

class Compiler {
 public:
  Compiler(const NetworkGraph& graph, const dnnl::engine& engine)
      : graph_(graph), engine_(engine), stream_(engine) {}

  Plan compile(const memory::dims& picture);

 private:
  void addConvolution(const NetworkLayer& layer, const FusedLayers& fused);
  void addEnlarge(const NetworkLayer& layer);
  void addMaxPool(const NetworkLayer& layer);
  void addRelu(const NetworkLayer& layer);
  void addSum(const NetworkLayer& layer);
  [[nodiscard]] memory::desc layoutFor(const memory::dims& size, const FusedLayers& fused) const;
  template <typename Primitive>
  void addStep(const typename Primitive::primitive_desc& chosen, Arguments arguments) {
    arguments.emplace(DNNL_ARG_SCRATCHPAD, memory(chosen.scratchpad_desc(), engine_));
    plan_.steps.push_back({Primitive(chosen), std::move(arguments)});
  }
  // A layer of one input, which is taken as it lies.
  template <typename Primitive>
  void addPlain(const NetworkLayer& layer, const typename Primitive::desc& wanted) {
    const typename Primitive::primitive_desc chosen(wanted, attributesOf(), engine_);
    const memory target(chosen.dst_desc(), engine_);
    addStep<Primitive>(chosen, {{DNNL_ARG_SRC, at(layer.inputs[0])}, {DNNL_ARG_DST, target}});
    keep(layer.output, target);
  }
  memory inLayout(const memory& value, const memory::desc& layout);
  memory constant(const memory::dims& size, Tag tag, const std::vector<float>& numbers,
                  const memory::desc& layout);
  void keep(int value, const memory& numbers) {
    values_[static_cast<std::size_t>(value)] = numbers;
  }
  [[nodiscard]] const memory& at(int value) const {
    return values_[static_cast<std::size_t>(value)];
  }

  const NetworkGraph& graph_;
  dnnl::engine engine_;
  dnnl::stream stream_;
  std::vector<memory> values_;
  Plan plan_;
};

memory::desc Compiler::layoutFor(const memory::dims& size, const FusedLayers& fused) const {
  if (!fused.sum) return anyLayout(size);
  const memory::desc layout = at(fused.added).get_desc();
  requireSameSize(layout.dims(), size);
  return layout;
}

memory Compiler::inLayout(const memory& value, const memory::desc& layout) {
  if (value.get_desc() == layout) return value;
  memory other(layout, engine_);
  const dnnl::reorder::primitive_desc chosen(engine_, value.get_desc(), engine_, layout,
                                             attributesOf());
  addStep<dnnl::reorder>(chosen, {{DNNL_ARG_FROM, value}, {DNNL_ARG_TO, other}});
  return other;
}

memory Compiler::constant(const memory::dims& size, Tag tag, const std::vector<float>& numbers,
                          const memory::desc& layout) {
  memory plain({size, kFloat, tag}, engine_);
  std::copy(numbers.begin(), numbers.end(), static_cast<float*>(plain.get_data_handle()));
  memory laid(layout, engine_);
  dnnl::reorder(plain, laid).execute(stream_, plain, laid);
  stream_.wait();
  return laid;
}

void Compiler::addConvolution(const NetworkLayer& layer, const FusedLayers& fused) {
  const memory source = at(layer.inputs[0]);
  const memory::dims in = source.get_desc().dims();
  memory::dims out = windows(in, layer);
  out[1] = layer.channels[0];
  const memory::dims kernel{layer.channels[0], layer.channels[1], layer.kernel[0], layer.kernel[1]};
  const dnnl::convolution_forward::desc wanted(
      dnnl::prop_kind::forward_inference, dnnl::algorithm::convolution_direct, anyLayout(in),
      anyLayout(kernel), memory::desc({layer.channels[0]}, kFloat, Tag::x), layoutFor(out, fused),
      dims(layer.stride), memory::dims{layer.dilation[0] - 1, layer.dilation[1] - 1},
      dims(layer.pad_before), dims(layer.pad_after));
  const dnnl::convolution_forward::primitive_desc chosen(wanted, attributesOf(fused), engine_);
  const memory laid = inLayout(source, chosen.src_desc());
  const memory target = fused.sum ? at(fused.added) : memory(chosen.dst_desc(), engine_);
  addStep<dnnl::convolution_forward>(
      chosen,
      {{DNNL_ARG_SRC, laid},
       {DNNL_ARG_WEIGHTS, constant(kernel, Tag::oihw, layer.weights, chosen.weights_desc())},
       {DNNL_ARG_BIAS, constant({layer.channels[0]}, Tag::x, layer.bias, chosen.bias_desc())},
       {DNNL_ARG_DST, target}});
  keep(fused.output, target);
}

void Compiler::addEnlarge(const NetworkLayer& layer) {
  const memory::desc source = at(layer.inputs[0]).get_desc();
  memory::dims out = source.dims();
  for (std::size_t i = 0; i < 2; ++i) out[2 + i] *= layer.factor[i];
  // A sum in place is left to addSum: where layouts differ oneDNN 2.6 gives wrong numbers.
  addPlain<dnnl::resampling_forward>(
      layer, {dnnl::prop_kind::forward_inference, dnnl::algorithm::resampling_linear, source,
              anyLayout(out)});
}

void Compiler::addMaxPool(const NetworkLayer& layer) {
  const memory::desc source = at(layer.inputs[0]).get_desc();
  addPlain<dnnl::pooling_forward>(
      layer, {dnnl::prop_kind::forward_inference, dnnl::algorithm::pooling_max, source,
              anyLayout(windows(source.dims(), layer)), dims(layer.stride), dims(layer.kernel),
              dims(layer.pad_before), dims(layer.pad_after)});
}

void Compiler::addRelu(const NetworkLayer& layer) {
  addPlain<dnnl::eltwise_forward>(
      layer, {dnnl::prop_kind::forward_inference, dnnl::algorithm::eltwise_relu,
              at(layer.inputs[0]).get_desc(), 0.0F});
}

void Compiler::addSum(const NetworkLayer& layer) {
  const memory first = at(layer.inputs[0]);
  requireSameSize(first.get_desc().dims(), at(layer.inputs[1]).get_desc().dims());
  const memory second = inLayout(at(layer.inputs[1]), first.get_desc());
  const dnnl::binary::desc wanted(dnnl::algorithm::binary_add, first.get_desc(), second.get_desc(),
                                  first.get_desc());
  const dnnl::binary::primitive_desc chosen(wanted, attributesOf(), engine_);
  const memory target(chosen.dst_desc(), engine_);
  addStep<dnnl::binary>(
      chosen, {{DNNL_ARG_SRC_0, first}, {DNNL_ARG_SRC_1, second}, {DNNL_ARG_DST, target}});
  keep(layer.output, target);
}

Plan Compiler::compile(const memory::dims& picture) {
  values_.assign(static_cast<std::size_t>(graph_.values), memory());
  plan_.picture = memory({picture, kFloat, Tag::nchw}, engine_);
  keep(0, plan_.picture);
  for (std::size_t i = 0; i < graph_.layers.size(); ++i) {
    const NetworkLayer& layer = graph_.layers[i];
    switch (layer.kind) {
      case NetworkLayer::Kind::kConvolution: {
        const FusedLayers fused = fuseFollowing(graph_, i);
        addConvolution(layer, fused);
        i += fused.count;
        break;
      }
      case NetworkLayer::Kind::kEnlarge:
        addEnlarge(layer);
        break;
      case NetworkLayer::Kind::kMaxPool:
        addMaxPool(layer);
        break;
      case NetworkLayer::Kind::kRelu:
        addRelu(layer);
        break;
      case NetworkLayer::Kind::kSum:
        addSum(layer);
        break;
    }
  }
  const memory::dims size = at(graph_.output).get_desc().dims();
  plan_.output = inLayout(at(graph_.output), {size, kFloat, Tag::nchw});
  const std::vector<int> sizes(size.begin(), size.end());
  plan_.result = cv::Mat(sizes, CV_32F, plan_.output.get_data_handle());
  return std::move(plan_);
}

}  // namespace

struct CompiledNetwork::Impl {
  NetworkGraph graph;
  dnnl::engine engine{dnnl::engine::kind::cpu, 0};
  dnnl::stream stream{engine};
  std::map<std::array<int, 4>, Plan> plans;  // by the picture's size
};

CompiledNetwork::CompiledNetwork(NetworkGraph graph) : impl_(std::make_unique<Impl>()) {
  impl_->graph = std::move(graph);
}
CompiledNetwork::CompiledNetwork(CompiledNetwork&&) noexcept = default;
CompiledNetwork& CompiledNetwork::operator=(CompiledNetwork&&) noexcept = default;
CompiledNetwork::~CompiledNetwork() = default;

Result<cv::Mat> CompiledNetwork::run(const cv::Mat& picture) {
  PARKADE_CHECK(picture.dims == 4 && picture.type() == CV_32F && picture.isContinuous(),
                "picture of {} dimensions, type {}", picture.dims, picture.type());
  const OneThread one_thread;
  const std::array<int, 4> size{picture.size[0], picture.size[1], picture.size[2], picture.size[3]};
  try {
    auto found = impl_->plans.find(size);
    if (found == impl_->plans.end()) {
      Plan plan = Compiler(impl_->graph, impl_->engine).compile({size.begin(), size.end()});
      found = impl_->plans.emplace(size, std::move(plan)).first;
    }
    Plan& plan = found->second;
    plan.picture.set_data_handle(picture.data);
    for (const Plan::Step& step : plan.steps) step.primitive.execute(impl_->stream, step.arguments);
    impl_->stream.wait();
    return plan.result;
  } catch (const dnnl::error& error) {
    return Error{error.what()};
  }
}

}  // namespace parkade
