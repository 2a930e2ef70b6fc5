// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Damages map files at random and reads them: fuzz_map FILES [SEED]. Every file must load or fail
// with a message; what loads is checked, exported and drawn. tools/fuzz_map.sh runs it under the
// sanitizers.
#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/map_test_support.hpp"
#include "parkade/mapping/storage/map_drawing.hpp"
#include "parkade/mapping/storage/map_export.hpp"
#include "parkade/mapping/storage/map_file.hpp"
#include "parkade/mapping/storage/sqlite.hpp"

namespace parkade {
namespace {

struct Outcome {
  int loaded = 0;
  int refused = 0;
};

std::string contentOf(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Bytes anywhere; SQLite's own structure makes most of these end early.
void damageBytes(std::string& bytes, Random& random) {
  const int hits = random.integer(1, 16);
  for (int i = 0; i < hits; ++i)
    bytes[random.index(bytes.size())] = static_cast<char>(random.bits());
  if (random.chance(0.1)) bytes.resize(random.index(bytes.size()));
  if (random.chance(0.1)) {  // a page in another's place
    constexpr std::size_t kPage = 4096;
    const std::size_t pages = bytes.size() / kPage;
    if (pages < 2) return;
    bytes.replace(kPage * random.index(pages), kPage,
                  bytes.substr(kPage * random.index(pages), kPage));
  }
}

// A sound database with unsound values.
std::string damagingSql(Random& random) {
  static const std::vector<std::string> kColumns = {"meta value",
                                                    "meta key",
                                                    "tile layer",
                                                    "tile x",
                                                    "tile y",
                                                    "tile cells",
                                                    "slot id",
                                                    "slot x0",
                                                    "slot y3",
                                                    "slot corner_sigma",
                                                    "slot shape",
                                                    "slot number",
                                                    "slot zone",
                                                    "slot last_seen_ns",
                                                    "slot probability_free",
                                                    "slot observations",
                                                    "object class",
                                                    "object x",
                                                    "object z",
                                                    "object text",
                                                    "object outline",
                                                    "object heading",
                                                    "object id",
                                                    "node id",
                                                    "node t_ns",
                                                    "node px",
                                                    "node qw",
                                                    "edge from_id",
                                                    "edge to_id",
                                                    "edge kind",
                                                    "edge pz",
                                                    "edge information"};
  const std::string& at = random.pick(kColumns);
  const std::string table = at.substr(0, at.find(' '));
  const std::string column = at.substr(at.find(' ') + 1);
  const std::vector<std::string> values = {"NULL",
                                           "''",
                                           "'text'",
                                           "x'fffe00'",
                                           "9e999",
                                           "-9e999",
                                           "1e300",
                                           "-1",
                                           "9223372036854775807",
                                           "0",
                                           fmt::format("{}", random.integer(-100, 100)),
                                           fmt::format("{}", random.uniform(-1e7, 1e7)),
                                           fmt::format("zeroblob({})", random.integer(0, 20000)),
                                           fmt::format("randomblob({})", random.integer(0, 9000)),
                                           "CAST(x'ff01fe' AS TEXT)"};
  if (random.chance(0.05)) return "DELETE FROM " + table;
  if (random.chance(0.02)) return "DROP TABLE " + table;
  if (random.chance(0.05)) {
    return fmt::format("ALTER TABLE {} RENAME COLUMN {} TO other", table, column);
  }
  const std::string where = random.chance(0.5)
                                ? ""
                                : fmt::format(" WHERE {} = (SELECT {} FROM {} LIMIT 1 OFFSET {})",
                                              column, column, table, random.integer(0, 5));
  return fmt::format("UPDATE OR REPLACE {} SET {} = {}{}", table, column, random.pick(values),
                     where);
}

void useMap(const ParkingMap& map, const std::string& folder) {
  static_cast<void>(findFaults(map));
  static_cast<void>(exportGeoJson(map, folder + "/map.geojson"));
  static_cast<void>(exportLanelet2(map, folder + "/map.osm"));
  // Pictures of what is merely large take seconds each and show nothing new.
  const auto bounds = map.grid.bounds();
  constexpr int kWide = 4000;
  if (bounds && (bounds->max - bounds->min).maxCoeff() > kWide) return;
  static_cast<void>(exportNav2(map, GridLayer::kParkingLines, folder));
  static_cast<void>(drawMap(map, 1.0));
}

int fuzz(int files, std::uint64_t seed) {
  const std::string folder =
      std::filesystem::temp_directory_path().string() + fmt::format("/fuzz_map_{}", getpid());
  std::filesystem::create_directories(folder);
  const std::string path = folder + "/map.db";
  ParkingMap map = testing::sampleMap(seed);
  {
    Result<MapFile> file = MapFile::open(path);
    if (!file || !file->save(map)) return 1;
  }
  const std::string good = contentOf(path);
  Random random(seed);
  Outcome outcome;
  for (int i = 0; i < files; ++i) {
    std::string bytes = good;
    const bool by_sql = random.chance(0.5);
    if (!by_sql) damageBytes(bytes, random);
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
    std::filesystem::remove(path + "-journal");
    if (by_sql) {
      try {
        sqlite::Database database(path, sqlite::Database::Mode::kReadWriteCreate);
        database.execute("PRAGMA synchronous = OFF");
        database.execute("PRAGMA journal_mode = MEMORY");
        const int statements = random.integer(1, 3);
        for (int k = 0; k < statements; ++k) database.execute(damagingSql(random));
      } catch (const sqlite::SqliteError&) {  // refused by SQLite: then the file is what it was
      }
    }
    const Result<ParkingMap> loaded = loadMap(path);
    if (loaded) {
      ++outcome.loaded;
      static_cast<void>(checkIntegrity(path));
      constexpr int kEvery = 8;
      if (outcome.loaded % kEvery == 0) useMap(*loaded, folder);
    } else if (loaded.error().message.empty()) {
      fmt::print("file {}: refused without a message\n", i);
      return 1;
    } else {
      ++outcome.refused;
    }
    constexpr int kReport = 10000;
    if ((i + 1) % kReport == 0) {
      fmt::print("{} files: {} loaded, {} refused\n", i + 1, outcome.loaded, outcome.refused);
      std::fflush(stdout);
    }
  }
  std::filesystem::remove_all(folder);
  fmt::print("{} files: {} loaded, {} refused with a message, none crashed\n", files,
             outcome.loaded, outcome.refused);
  return outcome.loaded > 0 && outcome.refused > 0 ? 0 : 1;
}

}  // namespace
}  // namespace parkade

int main(int argc, char** argv) {
  const int files = argc > 1 ? std::atoi(argv[1]) : 1000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  return parkade::fuzz(files, seed);
}
