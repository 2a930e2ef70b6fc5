// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/storage/map_export.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/map_test_support.hpp"
#include "parkade/mapping/storage/map_drawing.hpp"

namespace parkade {
namespace {

using ::testing::HasSubstr;
using testing::sampleMap;

std::string folder() {
  const std::string path = ::testing::TempDir() + "parkade_export";
  std::filesystem::create_directories(path);
  return path;
}

std::string contentOf(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(MapExport, Nav2PictureHasTheCellsWhereTheYamlSays) {
  ParkingMap map;
  map.grid.add(GridLayer::kParkingLines, {1.02, 2.02}, SemanticClass::kSlotLine, 2.0F);
  map.grid.add(GridLayer::kParkingLines, {1.12, 2.12}, SemanticClass::kFloor, 2.0F);
  ASSERT_TRUE(exportNav2(map, GridLayer::kParkingLines, folder()));
  const std::string pgm = contentOf(folder() + "/parking_lines.pgm");
  ASSERT_THAT(pgm, ::testing::StartsWith("P5\n3 3\n255\n"));
  const std::string cells = pgm.substr(pgm.size() - 9);
  // Row 0 is the far side (largest y): the free cell at the right; the line is bottom left.
  EXPECT_EQ(static_cast<unsigned char>(cells[2]), 254);
  EXPECT_EQ(static_cast<unsigned char>(cells[6]), 0);
  EXPECT_EQ(static_cast<unsigned char>(cells[4]), 205);
  const std::string yaml = contentOf(folder() + "/parking_lines.yaml");
  EXPECT_THAT(yaml, HasSubstr("origin: [1, 2, 0.0]"));
  EXPECT_THAT(yaml, HasSubstr("resolution: 0.05"));
}

TEST(MapExport, EmptyMapGivesOneUnknownCell) {
  EXPECT_EQ(nav2PictureSize(ParkingMap()), Eigen::Vector2d(1.0, 1.0));
  ASSERT_TRUE(exportNav2(ParkingMap(), GridLayer::kDynamic, folder()));
  EXPECT_THAT(contentOf(folder() + "/dynamic.pgm"), ::testing::StartsWith("P5\n1 1\n"));
}

TEST(MapExport, GeoJsonHasClosedCounterClockwiseRings) {
  const ParkingMap map = sampleMap();
  const std::string path = folder() + "/map.geojson";
  ASSERT_TRUE(exportGeoJson(map, path));
  const nlohmann::json document = nlohmann::json::parse(contentOf(path));
  ASSERT_EQ(document["features"].size(), map.slots.size() + map.objects.size());
  EXPECT_EQ(document["coordinate_reference"]["unit"], "metre");
  const auto ring = document["features"][0]["geometry"]["coordinates"][0];
  ASSERT_EQ(ring.size(), 5U);
  EXPECT_EQ(ring.front(), ring.back());
  double twice_area = 0.0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    twice_area += ring[i][0].get<double>() * ring[i + 1][1].get<double>() -
                  ring[i + 1][0].get<double>() * ring[i][1].get<double>();
  }
  EXPECT_NEAR(twice_area, 2.0 * 12.5, 1e-9);
  EXPECT_EQ(document["features"][0]["properties"]["kind"], "parking_space");
}

TEST(MapExport, NoTwoFeaturesOfTheGeoJsonAreCalledAlike) {
  ParkingMap map = sampleMap();
  ASSERT_FALSE(map.objects.empty());
  map.objects[0].id = map.slots[0].id;
  const std::string path = folder() + "/ids.geojson";
  ASSERT_TRUE(exportGeoJson(map, path));
  const nlohmann::json document = nlohmann::json::parse(contentOf(path));
  std::set<std::string> ids;
  for (const auto& feature : document["features"]) ids.insert(feature["id"].get<std::string>());
  EXPECT_EQ(ids.size(), map.slots.size() + map.objects.size());
}

TEST(MapExport, Lanelet2HasASpacePerSlotFromAisleToRear) {
  const ParkingMap map = sampleMap();
  const std::string path = folder() + "/map.osm";
  ASSERT_TRUE(exportLanelet2(map, path));
  const std::string osm = contentOf(path);
  std::size_t spaces = 0;
  for (std::size_t at = osm.find("parking_space"); at != std::string::npos;
       at = osm.find("parking_space", at + 1)) {
    ++spaces;
  }
  EXPECT_EQ(spaces, map.slots.size());
  EXPECT_THAT(osm, HasSubstr("<tag k=\"width\" v=\"2.500\"/>"));
  EXPECT_THAT(osm, HasSubstr("<tag k=\"type\" v=\"parking_lot\"/>"));
  // The first slot's way starts at the middle of its entrance.
  EXPECT_THAT(osm.substr(0, 400), HasSubstr("<tag k=\"local_x\" v=\"1.2500\"/>"));
  EXPECT_THAT(osm.substr(0, 400), HasSubstr("<tag k=\"local_y\" v=\"3.0000\"/>"));
}

// Where the nodes of the last way lie, and how they are called.
std::vector<std::pair<std::string, Eigen::Vector2d>> lastWay(const std::string& osm) {
  const auto after = [&](const std::string& key, std::size_t from) {
    const std::size_t at = osm.find(key, from);
    return at == std::string::npos ? at : at + key.size();
  };
  std::vector<std::pair<std::string, Eigen::Vector2d>> nodes;
  const std::string key = "<nd ref=\"";
  for (std::size_t at = after(key, osm.rfind("<way ")); at != std::string::npos;
       at = after(key, at)) {
    const std::string id = osm.substr(at, osm.find('"', at) - at);
    const std::size_t node = osm.find("<node id=\"" + id + "\"");
    nodes.emplace_back(id,
                       Eigen::Vector2d(std::stod(osm.substr(after("local_x\" v=\"", node), 12)),
                                       std::stod(osm.substr(after("local_y\" v=\"", node), 12))));
  }
  return nodes;
}

TEST(MapExport, Lanelet2sPolygonRunsClockwiseAndIsOpen) {
  const std::string path = folder() + "/polygon.osm";
  ASSERT_TRUE(exportLanelet2(sampleMap(), path));
  const auto nodes = lastWay(contentOf(path));
  ASSERT_GE(nodes.size(), 4U);
  EXPECT_NE(nodes.front().first, nodes.back().first);
  std::vector<Eigen::Vector2d> corners;
  for (const auto& [id, p] : nodes) corners.push_back(p);
  EXPECT_NEAR(signedArea(corners), -75.0, 1e-3);  // six slots of 2.5 x 5 m
}

TEST(MapExport, UnwritableFolderIsNamed) {
  const Status status = exportGeoJson(sampleMap(), "/nowhere/map.geojson");
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("/nowhere/map.geojson"));
}

TEST(MapExport, MapOfAbsurdExtentIsRefused) {
  ParkingMap map = sampleMap();
  map.grid.add(GridLayer::kParkingLines, {1e6, -1e6}, SemanticClass::kSlotLine, 1.0F);
  EXPECT_FALSE(checkPictureSize(nav2PictureSize(map)));
  EXPECT_THAT(exportNav2(map, GridLayer::kDynamic, folder()).error().message,
              HasSubstr("pixels, more than"));
}

TEST(MapExport, TextThatIsNoTextIsReplaced) {
  ParkingMap map = sampleMap();
  map.slots[0].number = "\xff\x01<";
  const std::string path = folder() + "/odd";
  ASSERT_TRUE(exportGeoJson(map, path));
  EXPECT_TRUE(nlohmann::json::accept(contentOf(path)));
  ASSERT_TRUE(exportLanelet2(map, path));
  EXPECT_EQ(contentOf(path).find('\x01'), std::string::npos);
}

}  // namespace
}  // namespace parkade
