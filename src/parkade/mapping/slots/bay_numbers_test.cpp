// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/bay_numbers.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "parkade/mapping/slots/row_test_support.hpp"

namespace parkade {
namespace {

using slot_registry::numberBays;
using testing::Garage;

// Bays of three slots each; "" where no number was read.
std::vector<MapSlot> slotsOf(const std::vector<std::string>& numbers) {
  std::vector<MapSlot> slots;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    slots.push_back(Garage::slotAt(static_cast<int>(i / 3), static_cast<int>(i % 3)));
    slots.back().number = numbers[i];
  }
  return slots;
}

// One bay, however long.
std::vector<MapSlot> longBayOf(const std::vector<std::string>& numbers) {
  std::vector<MapSlot> slots;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    slots.push_back(Garage::slotAt(0, static_cast<int>(i)));
    slots.back().number = numbers[i];
  }
  return slots;
}

std::vector<std::string> numberedSlots(std::vector<MapSlot> slots, std::vector<double> support) {
  if (support.empty()) {
    for (const MapSlot& slot : slots) support.push_back(slot.number.empty() ? 0.0 : 3.0);
  }
  numberBays(slots, support);
  std::vector<std::string> result;
  for (const MapSlot& slot : slots) result.push_back(slot.number);
  return result;
}

std::vector<std::string> numbered(const std::vector<std::string>& numbers,
                                  std::vector<double> support = {}) {
  return numberedSlots(slotsOf(numbers), std::move(support));
}

using Numbers = std::vector<std::string>;

TEST(BayNumbers, ABayIsNumberedOneAfterTheOther) {
  EXPECT_EQ(numbered({"7", "8", "9", "14", "15", "", "", "42", ""}),
            (Numbers{"7", "8", "9", "14", "15", "16", "41", "42", "43"}));
}

TEST(BayNumbers, DownwardsAndWithLetters) {
  EXPECT_EQ(numbered({"B9", "B8", "B7", "B15", "B14", "", "", "", "B40"}),
            (Numbers{"B9", "B8", "B7", "B15", "B14", "B13", "B42", "B41", "B40"}));
}

TEST(BayNumbers, WhatIsOutvotedGivesWay) {
  const Numbers read = {"7", "8", "9", "14", "15", "76"};
  EXPECT_EQ(numbered(read, {5, 5, 5, 5, 5, 2}), (Numbers{"7", "8", "9", "14", "15", "16"}));
  EXPECT_EQ(numbered(read, {5, 5, 5, 5, 5, 9}), read);  // it does not by so little
}

TEST(BayNumbers, ASlotWithoutANumberPartsABay) {
  const auto numberedBay = [](const Numbers& read) { return numberedSlots(longBayOf(read), {}); };
  const Numbers reserved = {"1", "2", "3", "4", "5", "6", "", "7", "8"};
  EXPECT_EQ(numberedBay(reserved), reserved);
  // Which number is between two parts nobody knows.
  EXPECT_EQ(numberedBay({"1", "2", "3", "", "5", "", "6", "7", ""}),
            (Numbers{"1", "2", "3", "", "5", "", "6", "7", "8"}));
  EXPECT_EQ(numberedBay({"", "2", "3", "76", "5", "6", "", "7", "8", ""}),
            (Numbers{"1", "2", "3", "4", "5", "6", "", "7", "8", "9"}));
}

TEST(BayNumbers, ReadingsThatANeighbourConfirmsStay) {
  // However surely another slot is read.
  const Numbers read = {"7", "8", "9", "14", "15", "76"};
  EXPECT_EQ(numbered(read, {5, 5, 5, 5, 5, 50}), read);
  // Nor does another bay take their numbers.
  EXPECT_EQ(numbered({"7", "8", "", "9", "10", "", "21", "22", "23"}, {9, 9, 0, 3, 3, 0, 3, 3, 3}),
            (Numbers{"7", "8", "", "9", "10", "11", "21", "22", "23"}));
}

TEST(BayNumbers, WithoutADirectionNothingIsTold) {
  const Numbers read = {"7", "8", "", "", "15", "", "", "42", ""};
  EXPECT_EQ(numbered(read), read);
  const Numbers torn = {"7", "8", "9", "15", "14", "13", "", "42", ""};
  EXPECT_EQ(numbered(torn), torn);
}

TEST(BayNumbers, ANumberIsGivenOnce) {
  EXPECT_EQ(numbered({"7", "8", "9", "10", "11", "", "", "10", ""}),
            (Numbers{"7", "8", "9", "10", "11", "12", "", "", ""}));
}

TEST(BayNumbers, NoNumberIsBelowOne) {
  EXPECT_EQ(numbered({"7", "8", "9", "14", "15", "16", "", "", "1"}),
            (Numbers{"7", "8", "9", "14", "15", "16", "", "", "1"}));
}

TEST(BayNumbers, ColumnsPartBays) {
  EXPECT_EQ(numbered({"7", "8", "9", "14", "15", "", "", "", ""}),
            (Numbers{"7", "8", "9", "14", "15", "16", "", "", ""}));
}

TEST(BayNumbers, WhatDoesNotCountStays) {
  EXPECT_EQ(numbered({"7", "8", "9", "14", "15", "16", "VIP", "", "07"}),
            (Numbers{"7", "8", "9", "14", "15", "16", "VIP", "", "07"}));
}

}  // namespace
}  // namespace parkade
