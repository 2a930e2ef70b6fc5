// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/bench_key.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "parkade/io/test_support.hpp"

namespace parkade::cli {
namespace {

class BenchKeyTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("models/bev_segmentation.yaml", "network: bev_segmentation.onnx");
    folder_.write("models/bev_segmentation.onnx", "one");
    ASSERT_EQ(setenv("PARKADE_MODELS", folder_.path("models").c_str(), 1), 0);
    variant_.run_method = "fused";
  }
  void TearDown() override { unsetenv("PARKADE_MODELS"); }

  [[nodiscard]] std::string key() const { return runKey(variant_, inputs_); }

  test::TemporaryFolder folder_;
  BenchVariant variant_;
  RunInputs inputs_{"", 2, "nowhere", ""};
};

TEST_F(BenchKeyTest, ThreadsCount) {
  const std::string before = key();
  EXPECT_EQ(key(), before);
  inputs_.threads = 3;
  EXPECT_NE(key(), before);
}

TEST_F(BenchKeyTest, OwnNetworksCountWhereTheyAreUsed) {
  const std::string fused = key();
  folder_.write("models/README.md", "notes");
  EXPECT_EQ(key(), fused);
  variant_.run_method = "vis";
  const std::string vis = key();
  folder_.write("models/bev_segmentation.onnx", "two");
  EXPECT_EQ(key(), vis);
  variant_.run_method = "fused";
  EXPECT_NE(key(), fused);
}

TEST_F(BenchKeyTest, NetworksThatSettingsNameCountWithTheirOnnxFiles) {
  variant_.settings = {"semantics.network=" + folder_.write("mine/net.yaml", "network: net.onnx")};
  const std::string without = key();
  folder_.write("mine/net.onnx", "one");
  const std::string one = key();
  EXPECT_NE(one, without);
  folder_.write("mine/other.onnx", "of another network");
  EXPECT_EQ(key(), one);
  folder_.write("mine/net.onnx", "two");
  EXPECT_NE(key(), one);
}

}  // namespace
}  // namespace parkade::cli
