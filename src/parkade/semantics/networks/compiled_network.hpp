// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "parkade/core/result.hpp"
#include "parkade/semantics/networks/network_graph.hpp"

namespace parkade {

/// Runs a layer graph by oneDNN, which compiles every convolution for the processor at hand, with
/// what follows it (rectifier, sum) as a part of it. Not thread-safe: it keeps buffers.
class CompiledNetwork {
 public:
  explicit CompiledNetwork(NetworkGraph graph);
  CompiledNetwork(CompiledNetwork&&) noexcept;
  CompiledNetwork& operator=(CompiledNetwork&&) noexcept;
  ~CompiledNetwork();

  /// picture: 1 x C x H x W of CV_32F; gives the same of its own output, overwritten by the next
  /// run on a picture of that size. The first picture of a size takes longer, since the layers are
  /// compiled for it. Fails where the graph does not take that size.
  Result<cv::Mat> run(const cv::Mat& picture);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
