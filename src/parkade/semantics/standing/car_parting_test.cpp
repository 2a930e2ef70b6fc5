// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/car_parting.hpp"

#include <gtest/gtest.h>

namespace parkade {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

void addFace(const Vector2d& from, const Vector2d& to, Points& points) {
  const int count = static_cast<int>((to - from).norm() / 0.05);
  for (int i = 0; i <= count; ++i) points.push_back(from + i * (to - from) / count);
}

std::vector<CarEdge> parted(const Points& swept) {
  constexpr double kNotch = 0.14;
  return partCars(swept, {3.0, 0.0}, kNotch, {}, [](const Points& points) { return points; });
}

TEST(CarParting, MoreThanACarPartsWhereTwoFitBest) {
  Points swept;
  addFace({0.0, 3.0}, {2.8, 3.0}, swept);
  const std::size_t first = swept.size();
  addFace({3.0, 3.8}, {6.0, 3.8}, swept);
  const std::vector<CarEdge> cars = parted(swept);
  ASSERT_EQ(cars.size(), 2U);
  EXPECT_EQ(cars[0].swept.size(), first);
}

TEST(CarParting, AWallOfOneFaceStaysOne) {
  Points swept;
  addFace({0.0, 3.0}, {6.5, 3.0}, swept);
  EXPECT_EQ(parted(swept).size(), 1U);
}

TEST(CarParting, InARowTheNearerCarIsAsWideAsCarsAre) {
  // Of the farther one no more than a corner is seen, and its front lies as far in.
  Points swept;
  addFace({4.0, 3.0}, {5.85, 3.0}, swept);
  const std::size_t first = swept.size();
  addFace({5.9, 3.02}, {6.9, 3.02}, swept);
  SlotObservation slot;
  slot.shape = SlotShape::kPerpendicular;
  slot.corners = {Eigen::Vector2d(1.1, 2.5), Eigen::Vector2d(3.6, 2.5), Eigen::Vector2d(3.6, 7.5),
                  Eigen::Vector2d(1.1, 7.5)};
  constexpr double kNotch = 0.14;
  const std::vector<CarEdge> cars =
      partCars(swept, {3.0, 0.0}, kNotch, {slot}, [](const Points& points) { return points; });
  ASSERT_EQ(cars.size(), 2U);
  EXPECT_NEAR(static_cast<double>(cars[0].swept.size()), static_cast<double>(first),
              0.2 * static_cast<double>(first));
}

TEST(CarParting, ACarsFrontAndFlankStayTogether) {
  Points swept;
  addFace({0.0, 3.0}, {1.8, 3.0}, swept);
  addFace({1.85, 3.05}, {1.85, 7.5}, swept);
  EXPECT_EQ(parted(swept).size(), 1U);
}

}  // namespace
}  // namespace parkade
