// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layered_grid.hpp"

#include <gtest/gtest.h>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

TEST(GridCell, EvidenceGathersAndSaturates) {
  GridCell cell;
  EXPECT_DOUBLE_EQ(cell.probability(), 0.5);
  addEvidence(cell, SemanticClass::kArrow, 1.0F);
  EXPECT_EQ(cell.semantic_class, SemanticClass::kArrow);
  EXPECT_NEAR(cell.probability(), 0.731, 0.001);
  for (int i = 0; i < 100; ++i) addEvidence(cell, SemanticClass::kArrow, 1.0F);
  EXPECT_EQ(cell.log_odds, 7 * 16);
}

TEST(GridCell, OtherClassWeakensThenTakesOver) {
  GridCell cell;
  addEvidence(cell, SemanticClass::kArrow, 2.0F);
  addEvidence(cell, SemanticClass::kStopLine, 1.5F);
  EXPECT_EQ(cell.semantic_class, SemanticClass::kArrow);
  EXPECT_EQ(cell.log_odds, 8);
  addEvidence(cell, SemanticClass::kStopLine, 1.5F);
  EXPECT_EQ(cell.semantic_class, SemanticClass::kStopLine);
  EXPECT_EQ(cell.log_odds, 16);
  addEvidence(cell, SemanticClass::kArrow, -3.0F);  // against what the cell does not claim
  EXPECT_EQ(cell.log_odds, 16);
  EXPECT_THROW(addEvidence(cell, SemanticClass::kUnknown, 1.0F), CheckError);
}

TEST(LayeredGrid, CellsAndPointsAgreeOnBothSidesOfZero) {
  const LayeredGrid grid(0.05);
  EXPECT_EQ(grid.cellOf({0.01, -0.01}), Eigen::Vector2i(0, -1));
  EXPECT_EQ(grid.cellOf({-3.21, 3.21}), Eigen::Vector2i(-65, 64));
  const LayeredGrid::TileIndex before{-2, 1};
  EXPECT_EQ(LayeredGrid::tileOf({-65, 64}), before);
  const LayeredGrid::TileIndex edge{-1, 0};
  EXPECT_EQ(LayeredGrid::tileOf({-64, 63}), edge);
  for (const int i : {-130, -64, -1, 0, 63, 64}) {
    EXPECT_EQ(grid.cellOf(grid.centerOf({i, -i})), Eigen::Vector2i(i, -i));
  }
}

TEST(LayeredGrid, LayersAreApartAndReadingMakesNoTiles) {
  LayeredGrid grid;
  grid.add(GridLayer::kParkingLines, {-1.0, 2.0}, SemanticClass::kSlotLine, 1.0F);
  const Eigen::Vector2i cell = grid.cellOf({-1.0, 2.0});
  EXPECT_TRUE(grid.at(GridLayer::kParkingLines, cell).known());
  EXPECT_FALSE(grid.at(GridLayer::kRoadMarkers, cell).known());
  EXPECT_TRUE(grid.tiles(GridLayer::kRoadMarkers).empty());
  ASSERT_TRUE(grid.bounds());
  EXPECT_EQ(grid.bounds()->min, cell);
  EXPECT_EQ(grid.bounds()->max, cell);
  EXPECT_FALSE(LayeredGrid().bounds());
}

TEST(LayeredGrid, FadingEndsInUnknownAndDropsTiles) {
  LayeredGrid grid;
  grid.add(GridLayer::kDynamic, {1.0, 1.0}, SemanticClass::kVehicle, 3.0F);
  grid.add(GridLayer::kParkingLines, {1.0, 1.0}, SemanticClass::kSlotLine, 3.0F);
  int steps = 0;
  while (!grid.tiles(GridLayer::kDynamic).empty()) {
    grid.fade(GridLayer::kDynamic, 0.8F);
    ASSERT_LT(++steps, 30);
  }
  EXPECT_GT(steps, 5);
  EXPECT_EQ(grid.tiles(GridLayer::kParkingLines).size(), 1U);
}

}  // namespace
}  // namespace parkade
