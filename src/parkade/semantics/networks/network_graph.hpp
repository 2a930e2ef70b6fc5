// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace parkade {

/// One layer of a convolutional network: it makes one value (N x C x H x W numbers) from one or
/// two.
struct NetworkLayer {
  enum class Kind { kConvolution, kRelu, kSum, kMaxPool, kEnlarge };
  Kind kind = Kind::kRelu;
  std::vector<int> inputs;  ///< indices of values; 0 is the picture
  int output = 0;           ///< index of the value that it makes
  // Of rows and of columns:
  std::array<int, 2> kernel{1, 1};
  std::array<int, 2> stride{1, 1};
  std::array<int, 2> pad_before{0, 0};
  std::array<int, 2> pad_after{0, 0};
  std::array<int, 2> dilation{1, 1};
  std::array<int, 2> factor{1, 1};    ///< kEnlarge: bilinear, by the middles of pixels
  std::array<int, 2> channels{0, 0};  ///< kConvolution: of output and of input
  std::vector<float> weights;         ///< kConvolution: output x input x rows x columns
  std::vector<float> bias;            ///< kConvolution: one per channel of the output
};

/// A network as a list of layers, each after those that it needs.
struct NetworkGraph {
  std::vector<NetworkLayer> layers;
  int values = 1;  ///< the picture and one per layer
  int output = 0;  ///< the value that is the network's
};

/// Reads an ONNX file (https://onnx.ai) that is made of convolutions, rectifiers, sums, maximum
/// pooling and bilinear enlargements by whole numbers, with one picture in and one value out. Of
/// another, or of what is no ONNX file: nothing.
std::optional<NetworkGraph> readNetworkGraph(const std::string& path);

}  // namespace parkade
