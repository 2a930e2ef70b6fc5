// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/onnx_network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>
#include <thread>

namespace parkade {
namespace {

const std::string kTestNetworks = std::string(PARKADE_SOURCE_DIR) + "/tests/data/networks/";
const std::string kModels = std::string(PARKADE_SOURCE_DIR) + "/models/";

cv::Mat noise(int height, int width, int seed) {
  const std::array<int, 4> shape{1, 3, height, width};
  cv::Mat picture(4, shape.data(), CV_32F);
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(picture, cv::RNG::NORMAL, 0.0, 1.0);
  return picture;
}

double largest(const cv::Mat& numbers) {
  const cv::Mat flat(1, static_cast<int>(numbers.total()), CV_32F, numbers.data);
  return cv::norm(flat, cv::NORM_INF);
}

struct SizedNetwork {
  std::string path;
  int height;
  int width;
};

class CompiledNetworks : public testing::TestWithParam<SizedNetwork> {};

TEST_P(CompiledNetworks, GiveWhatOpenCvGives) {
  const SizedNetwork& param = GetParam();
  Result<OnnxNetwork> network = OnnxNetwork::read(param.path, "test");
  ASSERT_TRUE(network) << network.error().message;
  EXPECT_TRUE(network->isCompiled());
  cv::dnn::Net reference = cv::dnn::readNetFromONNX(param.path);
  for (const int seed : {1, 2}) {  // nothing may be left of the run before
    const cv::Mat picture = noise(param.height, param.width, seed);
    const cv::Mat untouched = picture.clone();
    const Result<cv::Mat> numbers = network->run(picture);
    ASSERT_TRUE(numbers) << numbers.error().message;
    reference.setInput(picture);
    const cv::Mat expected = reference.forward();
    ASSERT_EQ(shapeOf(*numbers), shapeOf(expected));
    const cv::Mat difference = *numbers - expected;
    EXPECT_LT(largest(difference), 1e-5 * std::max(1.0, largest(expected)));
    EXPECT_EQ(largest(picture - untouched), 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(OfParkade, CompiledNetworks,
                         testing::Values(SizedNetwork{kTestNetworks + "layers.onnx", 16, 24},
                                         SizedNetwork{kTestNetworks + "layers.onnx", 48, 32},
                                         SizedNetwork{kTestNetworks + "blocks.onnx", 16, 16},
                                         SizedNetwork{kModels + "bev_segmentation.onnx", 384, 384},
                                         SizedNetwork{kModels + "view_segmentation.onnx", 192, 320},
                                         SizedNetwork{kModels + "zone_text.onnx", 40, 96},
                                         SizedNetwork{kModels + "zone_text.onnx", 72, 96},
                                         SizedNetwork{kModels + "slot_number.onnx", 40, 96}));

TEST(OnnxNetwork, TakesSizesInTurns) {
  Result<OnnxNetwork> network = OnnxNetwork::read(kTestNetworks + "layers.onnx", "test");
  ASSERT_TRUE(network) << network.error().message;
  const cv::Mat small = noise(16, 24, 3);
  const cv::Mat large = noise(32, 40, 4);
  const cv::Mat first = network->run(small)->clone();
  const cv::Mat other = network->run(large)->clone();
  EXPECT_EQ(shapeOf(first), "1 x 5 x 8 x 12");
  EXPECT_EQ(shapeOf(other), "1 x 5 x 16 x 20");
  EXPECT_EQ(largest(*network->run(small) - first), 0.0);
  EXPECT_EQ(largest(*network->run(large) - other), 0.0);
}

TEST_P(CompiledNetworks, RunInAnotherThreadThanTheyWereCompiledIn) {
  const SizedNetwork& param = GetParam();
  Result<OnnxNetwork> network = OnnxNetwork::read(param.path, "test");
  ASSERT_TRUE(network) << network.error().message;
  const cv::Mat picture = noise(param.height, param.width, 6);
  const cv::Mat here = network->run(picture)->clone();
  cv::Mat there;
  std::thread([&] { there = network->run(picture)->clone(); }).join();
  EXPECT_EQ(largest(here - there), 0.0);
}

TEST(OnnxNetwork, OtherLayersAreLeftToOpenCv) {
  Result<OnnxNetwork> network = OnnxNetwork::read(kTestNetworks + "sigmoid.onnx", "test");
  ASSERT_TRUE(network) << network.error().message;
  EXPECT_FALSE(network->isCompiled());
  for (const int size : {16, 8, 16}) {
    const cv::Mat picture = noise(size, size, size);
    const Result<cv::Mat> numbers = network->run(picture);
    ASSERT_TRUE(numbers) << numbers.error().message;
    ASSERT_EQ(shapeOf(*numbers), shapeOf(cv::Mat({1, 1, size, size}, CV_32F)));
    for (int v = 0; v < size; ++v) {
      for (int u = 0; u < size; ++u) {
        double sum = 0.0;
        for (int c = 0; c < 3; ++c) sum += picture.ptr<float>(0, c, v)[u];
        ASSERT_NEAR(numbers->ptr<float>(0, 0, v)[u], 1.0 / (1.0 + std::exp(-sum)), 1e-5);
      }
    }
  }
}

TEST(OnnxNetwork, ASizeThatDoesNotFitIsRefused) {
  Result<OnnxNetwork> network = OnnxNetwork::read(kTestNetworks + "layers.onnx", "test");
  ASSERT_TRUE(network) << network.error().message;
  // Half of the rows is odd: shrunk and enlarged it has one less.
  const Result<cv::Mat> numbers = network->run(noise(18, 24, 5));
  ASSERT_FALSE(numbers);
  EXPECT_THAT(numbers.error().message,
              testing::AllOf(testing::HasSubstr("layers.onnx"), testing::HasSubstr("24 x 18 px")));
  EXPECT_TRUE(network->run(noise(16, 24, 5)));
}

}  // namespace
}  // namespace parkade
