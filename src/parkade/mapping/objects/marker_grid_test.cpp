// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/marker_grid.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "parkade/mapping/objects/marker_counts.hpp"

namespace parkade {
namespace {

// Pillars 8 m and 17 m apart, turned by 0.3 rad: letters along the rows, digits across them.
class MarkerGrid : public testing::Test {
 protected:
  MarkerGrid() {
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        markers_.push_back({at(8.0 * column, 17.0 * row), name(row, column)});
      }
    }
  }

  static Eigen::Vector2d at(double x, double y) {
    return {std::cos(0.3) * x - std::sin(0.3) * y, std::sin(0.3) * x + std::cos(0.3) * y};
  }
  static std::string name(int row, int column) {
    return fmt::format("{}{}", static_cast<char>('A' + row), column + 9);
  }
  NamedMarker& marker(int row, int column) {
    return markers_[static_cast<std::size_t>(row * kColumns + column)];
  }
  void expectAllRight() {
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        EXPECT_EQ(marker(row, column).text, name(row, column));
      }
    }
  }

  static constexpr int kRows = 4;
  static constexpr int kColumns = 7;
  std::vector<NamedMarker> markers_;
};

TEST_F(MarkerGrid, LeavesWhatIsRight) {
  nameByGrid(markers_);
  expectAllRight();
}

TEST_F(MarkerGrid, MendsLettersAndDigits) {
  marker(1, 2).text = "D11";  // B11
  marker(3, 1).text = "D1";   // D10, the last digit hidden
  marker(0, 5).text = "C4";   // A14
  nameByGrid(markers_);
  expectAllRight();
}

TEST_F(MarkerGrid, NamesWhatWasNotRead) {
  marker(2, 3).text.clear();
  marker(0, 0).text.clear();
  nameByGrid(markers_);
  expectAllRight();
}

// 11 read as 12 all along a line, which the next one is, too.
TEST_F(MarkerGrid, MendsALineMisreadAlike) {
  for (int row = 0; row < kRows; ++row) marker(row, 2).text = name(row, 3);
  nameByGrid(markers_);
  expectAllRight();
}

// At the edge nobody knows which of the two lines is misread, nor whether one was passed unseen.
TEST_F(MarkerGrid, LinesOfOneNumberAtTheEdgeStay) {
  for (int row = 0; row < kRows; ++row) marker(row, 0).text = name(row, 1);
  const std::vector<NamedMarker> before = markers_;
  nameByGrid(markers_);
  for (std::size_t i = 0; i < markers_.size(); ++i) EXPECT_EQ(markers_[i].text, before[i].text);
}

TEST(MarkerCounts, NumbersOutOfStep) {
  using Mended = std::vector<std::optional<int>>;
  const auto at = [](std::vector<int> numbers, double spacing) {
    std::vector<CountedLine> lines;
    for (const int number : numbers) {
      lines.push_back({spacing * static_cast<double>(lines.size()), number});
    }
    return lines;
  };
  const auto no = std::nullopt;
  EXPECT_EQ(mendedCounts(at({14, 16, 16, 17, 18, 19}, 8.0)), (Mended{no, 15, no, no, no, no}));
  // Counted the other way, and told in any order.
  EXPECT_EQ(mendedCounts(at({14, 16, 16, 17, 18, 19}, -8.0)), (Mended{no, 15, no, no, no, no}));
  // Both 16 and 17 stand between, one line was not seen: nobody knows.
  EXPECT_EQ(mendedCounts(at({14, 17, 17, 18, 19, 20}, 8.0)), Mended(6));
  // 23 is out of step, too, but no other line's number: it may begin another zone.
  EXPECT_EQ(mendedCounts(at({14, 23, 16, 17, 18, 19}, 8.0)), Mended(6));
  // Numbers that do not count lines.
  EXPECT_EQ(mendedCounts(at({1, 1, 3, 7, 2, 8}, 8.0)), Mended(6));
  EXPECT_EQ(mendedCounts({}), Mended{});
}

TEST_F(MarkerGrid, GivesNoNameTwice) {
  // Two that were not read stand in one place of the grid: one of them is none, nobody knows which.
  marker(2, 3).text.clear();
  markers_.push_back({at(8.0 * 3 + 0.4, 17.0 * 2 + 0.3), ""});
  // And one that is misread while its name is given to another.
  marker(1, 4).text = "C12";
  markers_.push_back({at(70.0, 80.0), "B13"});
  nameByGrid(markers_);
  EXPECT_EQ(marker(2, 3).text, "");
  EXPECT_EQ(markers_[kRows * kColumns].text, "");
  EXPECT_EQ(marker(1, 4).text, "C12");
}

TEST_F(MarkerGrid, WhatStandsInNoLineKeepsItsName) {
  markers_.push_back({at(12.0, 25.0), "F3"});
  markers_.push_back({at(-4.0, 30.0), ""});
  nameByGrid(markers_);
  EXPECT_EQ(markers_[kRows * kColumns].text, "F3");
  EXPECT_EQ(markers_[kRows * kColumns + 1].text, "");
  expectAllRight();
}

// Zones that end in the middle of a line: its markers differ, so that nobody is sure.
TEST_F(MarkerGrid, BordersOfZonesStay) {
  std::vector<NamedMarker> before;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 3; column < kColumns; ++column) {
      marker(row, column).text[0] = static_cast<char>('E' + row);
    }
  }
  before = markers_;
  nameByGrid(markers_);
  for (std::size_t i = 0; i < markers_.size(); ++i) EXPECT_EQ(markers_[i].text, before[i].text);
}

TEST_F(MarkerGrid, OtherNamesStay) {
  // Numbered one after the other, as slots are.
  for (std::size_t i = 0; i < markers_.size(); ++i) markers_[i].text = fmt::format("P{}", i + 1);
  markers_[7].text.clear();
  std::vector<NamedMarker> before = markers_;
  nameByGrid(markers_);
  for (std::size_t i = 0; i < markers_.size(); ++i) EXPECT_EQ(markers_[i].text, before[i].text);
  // A zone each half of the garage, on all its pillars.
  for (std::size_t i = 0; i < markers_.size(); ++i) markers_[i].text = i < 12 ? "B1" : "B2";
  markers_[7].text.clear();
  before = markers_;
  nameByGrid(markers_);
  for (std::size_t i = 0; i < markers_.size(); ++i) EXPECT_EQ(markers_[i].text, before[i].text);
  std::vector<NamedMarker> none;
  nameByGrid(none);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace parkade
