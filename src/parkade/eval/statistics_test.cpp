// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

TEST(Statistics, KnownList) {
  const Statistics s = describe({4.0, 1.0, 3.0, 2.0});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 4.0);
  EXPECT_DOUBLE_EQ(s.p95, 3.85);
}

TEST(Statistics, OneAndNone) {
  const Statistics one = describe({7.0});
  EXPECT_EQ(one.rmse, 7.0);
  EXPECT_EQ(one.p95, 7.0);
  EXPECT_EQ(one.std, 0.0);
  const Statistics none = describe({});
  EXPECT_EQ(none.count, 0u);
  EXPECT_TRUE(std::isnan(none.rmse));
}

TEST(Statistics, StandardDeviationKeepsItsDigitsFarFromZero) {
  EXPECT_NEAR(describe({1e8 + 1.0, 1e8 - 1.0}).std, 1.0, 1e-9);
}

TEST(Statistics, Quantile) {
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0}, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0}, 0.25), 1.5);
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0}, 1.0), 3.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_THROW(static_cast<void>(quantile({1.0}, 1.5)), CheckError);
}

}  // namespace
}  // namespace parkade
