// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Runs a network as the program does on raw numbers, for tools/train/export.py to compare with
// torch:
//   parkade_onnx_check NETWORK.onnx WIDTH HEIGHT IN OUT     (float32, 1 x 3 x HEIGHT x WIDTH)
#include <array>
#include <cstdio>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>

#include "parkade/semantics/networks/onnx_network.hpp"

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: parkade_onnx_check NETWORK.onnx WIDTH HEIGHT IN OUT\n");
    return 2;
  }
  try {
    const std::array<int, 4> shape{1, 3, std::stoi(argv[3]), std::stoi(argv[2])};
    cv::Mat picture(4, shape.data(), CV_32F);
    std::ifstream in(argv[4], std::ios::binary);
    in.read(reinterpret_cast<char*>(picture.data),
            static_cast<std::streamsize>(picture.total() * 4));
    if (!in) throw std::runtime_error(std::string(argv[4]) + ": too short");
    parkade::Result<parkade::OnnxNetwork> network =
        parkade::OnnxNetwork::read(argv[1], "parkade_onnx_check");
    if (!network) throw std::runtime_error(network.error().message);
    const parkade::Result<cv::Mat> logits = network->run(picture);
    if (!logits) throw std::runtime_error(logits.error().message);
    std::ofstream(argv[5], std::ios::binary)
        .write(reinterpret_cast<const char*>(logits->data),
               static_cast<std::streamsize>(logits->total() * 4));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "parkade_onnx_check: %s\n", error.what());
    return 1;
  }
  return 0;
}
