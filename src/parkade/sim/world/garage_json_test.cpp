// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/garage_json.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "parkade/sim/world/generate.hpp"

namespace parkade::sim {
namespace {

std::string scratch(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("parkade_garage_json_" + name)).string();
}

Garage make(const std::string& preset, int seed) {
  GarageOptions options;
  options.preset = preset;
  options.seed = seed;
  return generateGarage(options).value();
}

TEST(GarageJsonTest, RoundTripKeepsEveryBit) {
  for (const int seed : {0, 3, 13}) {
    const Garage garage = make(seed == 0 ? "paper" : "random", seed);
    const std::string path = scratch("round.json");
    ASSERT_TRUE(writeGarageTruth(garage, path).ok());
    const Result<Garage> back = readGarageTruth(path);
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(garageTruthText(*back), garageTruthText(garage));
    ASSERT_EQ(back->slots.size(), garage.slots.size());
    for (std::size_t i = 0; i < garage.slots.size(); ++i) {
      EXPECT_EQ(back->slots[i].corners, garage.slots[i].corners);
      EXPECT_EQ(back->slots[i].occupied, garage.slots[i].occupied);
    }
    ASSERT_EQ(back->markings.size(), garage.markings.size());
    EXPECT_EQ(back->markings.back().polygons, garage.markings.back().polygons);
    EXPECT_EQ(back->floorHeight({50.0, 20.0}), garage.floorHeight({50.0, 20.0}));
    std::filesystem::remove(path);
  }
}

TEST(GarageJsonTest, NamesWhatIsWrong) {
  const std::string path = scratch("bad.json");
  const auto problem = [&](const std::string& from, const std::string& to) {
    std::string text = garageTruthText(make("random", 8));
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    text.replace(place, from.size(), to);
    std::ofstream(path) << text;
    const Result<Garage> garage = readGarageTruth(path);
    EXPECT_FALSE(garage.ok());
    std::filesystem::remove(path);
    return garage.ok() ? std::string() : garage.error().message;
  };
  EXPECT_NE(problem("\"version\": 1", "\"version\": 7").find("version 7"), std::string::npos);
  EXPECT_NE(problem("\"class\": \"slot_line\"", "\"class\": \"river\"").find("river"),
            std::string::npos);
  EXPECT_NE(problem("\"slots\"", "\"slits\"").find("'slots'"), std::string::npos);
  EXPECT_NE(problem("\"occupied\": ", "\"occupied\": 3").find("bad.json"), std::string::npos);
  EXPECT_NE(readGarageTruth(scratch("absent.json")).error().message.find("cannot be opened"),
            std::string::npos);
  EXPECT_FALSE(writeGarageTruth(make("paper", 0), "/nonexistent/garage.json").ok());
}

}  // namespace
}  // namespace parkade::sim
