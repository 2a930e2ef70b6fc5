// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/storage/map_file.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "parkade/core/random.hpp"
#include "parkade/mapping/map_test_support.hpp"
#include "parkade/mapping/storage/map_rows.hpp"
#include "parkade/mapping/storage/sqlite.hpp"

namespace parkade {
namespace {

using ::testing::HasSubstr;
using testing::sampleMap;

class MapFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "parkade_map_" + std::to_string(getpid()) + "/";
    std::filesystem::create_directories(folder_);
    path_ = folder_ + "map.db";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void save(ParkingMap& map) {
    Result<MapFile> file = MapFile::open(path_);
    ASSERT_TRUE(file) << file.error().message;
    const Status saved = file->save(map);
    ASSERT_TRUE(saved) << saved.error().message;
  }
  // Another process saves maps one after the other, and is killed after a while.
  void killWhileSaving(std::uint64_t seed, std::chrono::milliseconds after) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      ParkingMap map = sampleMap(seed);
      Result<MapFile> file = MapFile::open(path_);
      while (file) {
        map.grid.add(GridLayer::kAvailability, {1.0, 2.0}, SemanticClass::kFloor, 0.1F);
        if (!file->save(map)) break;
      }
      _exit(1);
    }
    std::this_thread::sleep_for(after);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  std::string folder_;
  std::string path_;
};

void expectSame(const ParkingMap& a, const ParkingMap& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_TRUE(a.grid == b.grid);
  EXPECT_TRUE(a.slots == b.slots);
  EXPECT_TRUE(a.objects == b.objects);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    EXPECT_EQ(a.nodes[i].id, b.nodes[i].id);
    EXPECT_EQ(a.nodes[i].t_ns, b.nodes[i].t_ns);
    EXPECT_LT((a.nodes[i].T_world_vehicle.matrix() - b.nodes[i].T_world_vehicle.matrix()).norm(),
              1e-15);
  }
  ASSERT_EQ(a.edges.size(), b.edges.size());
  for (std::size_t i = 0; i < a.edges.size(); ++i) {
    EXPECT_EQ(a.edges[i].kind, b.edges[i].kind);
    EXPECT_EQ(a.edges[i].information, b.edges[i].information);
  }
}

TEST_F(MapFileTest, RoundTripIsIdentical) {
  ParkingMap map = sampleMap();
  save(map);
  const Result<ParkingMap> loaded = loadMap(path_);
  ASSERT_TRUE(loaded) << loaded.error().message;
  expectSame(map, *loaded);
}

TEST_F(MapFileTest, NewFileIsAnEmptyMap) {
  ASSERT_TRUE(MapFile::open(path_));
  const Result<ParkingMap> loaded = loadMap(path_);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(loaded->slots.empty());
}

TEST_F(MapFileTest, LaterSavesWriteChangesAndRemovals) {
  ParkingMap map = sampleMap();
  Result<MapFile> file = MapFile::open(path_);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->save(map));
  map.grid.add(GridLayer::kParkingLines, {50.0, 50.0}, SemanticClass::kSlotLine, 2.0F);
  map.grid.fade(GridLayer::kDynamic, 0.0F);
  map.slots.pop_back();
  ASSERT_TRUE(file->save(map));
  const Result<ParkingMap> loaded = loadMap(path_);
  ASSERT_TRUE(loaded) << loaded.error().message;
  expectSame(map, *loaded);
  EXPECT_TRUE(loaded->grid.tiles(GridLayer::kDynamic).empty());
}

TEST_F(MapFileTest, TilesTakeLittleMoreThanTheyHold) {
  // Worn lines: tiles of some 1.5 KB, as those of real maps.
  ParkingMap map;
  Random random(11);
  constexpr int kTiles = 20;
  for (int x = 0; x < kTiles * LayeredGrid::kTileCells; ++x) {
    for (int y = 0; y < kTiles * LayeredGrid::kTileCells; y += 3) {
      map.grid.set(GridLayer::kParkingLines, {x, y}, SemanticClass::kSlotLine,
                   static_cast<float>(random.uniform(0.5, 6.0)));
    }
  }
  std::size_t held = 0;
  for (const auto& [at, tile] : map.grid.tiles(GridLayer::kParkingLines)) {
    held += packTile(tile).size();
  }
  save(map);
  EXPECT_GT(held, 1000U * kTiles * kTiles);
  EXPECT_LT(std::filesystem::file_size(path_), held + held / 2);
}

TEST_F(MapFileTest, ForeignAndMissingFilesAreNamed) {
  EXPECT_THAT(loadMap(folder_ + "none.db").error().message, HasSubstr("none.db: there is no such"));
  std::ofstream(path_)
      << "these are no pages of a database, but a text of some length ............";
  EXPECT_THAT(loadMap(path_).error().message, HasSubstr(path_));
  EXPECT_FALSE(MapFile::open(path_));  // and it stays as it is
  std::string content;
  std::getline(std::ifstream(path_), content);
  EXPECT_THAT(content, HasSubstr("no pages"));
  const std::string other = folder_ + "other.db";
  {
    sqlite::Database database(other, sqlite::Database::Mode::kReadWriteCreate);
    database.execute("CREATE TABLE t (a)");
  }
  EXPECT_THAT(loadMap(other).error().message, HasSubstr("no Parkade map"));
  EXPECT_THAT(MapFile::open(other).error().message, HasSubstr("no Parkade map"));
}

TEST_F(MapFileTest, ViewsAndTriggersAreRefused) {
  ParkingMap map = sampleMap();
  save(map);
  sqlite::Database database(path_, sqlite::Database::Mode::kReadWriteCreate);
  database.execute(
      "CREATE VIEW endless AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL "
      "SELECT i + 1 FROM n) SELECT i FROM n");
  const Result<ParkingMap> loaded = loadMap(path_);
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("views or triggers"));
}

TEST_F(MapFileTest, ValuesOutOfRangeAreNamed) {
  const auto messageAfter = [&](const std::string& sql) {
    ParkingMap map = sampleMap();
    save(map);
    {
      sqlite::Database database(path_, sqlite::Database::Mode::kReadWriteCreate);
      database.execute(sql);
    }
    const Result<ParkingMap> loaded = loadMap(path_);
    EXPECT_FALSE(loaded) << sql;
    std::filesystem::remove(path_);
    return loaded ? std::string() : loaded.error().message;
  };
  EXPECT_THAT(messageAfter("UPDATE slot SET probability_free = 1.5"),
              HasSubstr("slot 10: probability_free is 1.5"));
  EXPECT_THAT(messageAfter("UPDATE slot SET x0 = 'wide' WHERE id = 12"),
              HasSubstr("slot 12: x0 is a text ('wide'), expected a number"));
  EXPECT_THAT(messageAfter("UPDATE slot SET x0 = 9e999"),
              HasSubstr("slot 10: x0 is inf, expected a finite number"));
  EXPECT_THAT(messageAfter("UPDATE slot SET zone = NULL WHERE id = 11"),
              HasSubstr("slot 11: zone is empty (NULL), expected a text"));
  EXPECT_THAT(messageAfter("UPDATE slot SET shape = 7"),
              HasSubstr("slot 10: shape is 7, expected 0 to 2"));
  EXPECT_THAT(messageAfter("UPDATE object SET class = 'ufo' WHERE id = 4"),
              HasSubstr("object 4: unknown class 'ufo'"));
  EXPECT_THAT(messageAfter("UPDATE object SET outline = x'00'"),
              HasSubstr("object 3: outline has 1 bytes"));
  EXPECT_THAT(messageAfter("UPDATE node SET qw = 3 WHERE id = 2"),
              HasSubstr("node 2: the quaternion (qx to qw) has the norm"));
  EXPECT_THAT(messageAfter("DELETE FROM node WHERE id = 2"),
              HasSubstr("edge 1 to 2: node 2 is missing"));
  EXPECT_THAT(messageAfter("UPDATE edge SET kind = 'loop' WHERE to_id = 3"),
              HasSubstr("edge 2 to 3: kind is a text ('loop'), expected a whole number"));
  EXPECT_THAT(messageAfter("UPDATE tile SET cells = x'0102' WHERE layer = 2 AND x = 0 AND y = 0"),
              HasSubstr("tile (0, 0) of layer 2: is damaged"));
  EXPECT_THAT(messageAfter("UPDATE tile SET x = 9999999 WHERE layer = 2 AND x = 0 AND y = 0"),
              HasSubstr("tile (9999999, 0) of layer 2: x and y may be"));
  EXPECT_THAT(messageAfter("UPDATE meta SET value = '0' WHERE key = 'resolution'"),
              HasSubstr("meta, key 'resolution': '0'"));
  EXPECT_THAT(messageAfter("UPDATE meta SET value = x'00' WHERE key = 'name'"),
              HasSubstr("meta, key 'name': value is a blob (1 bytes), expected a text"));
  EXPECT_THAT(messageAfter("PRAGMA user_version = 9"), HasSubstr("schema version 9"));
  EXPECT_THAT(messageAfter("ALTER TABLE slot DROP COLUMN last_seen_ns"),
              HasSubstr("slot 10: column number 15 is missing"));
  EXPECT_THAT(messageAfter("DROP TABLE edge"), HasSubstr("edge"));
}

TEST_F(MapFileTest, TextInMessagesIsShortAndPrintable) {
  EXPECT_EQ(sqlite::quoted("ufo"), "'ufo'");
  EXPECT_EQ(sqlite::quoted("a\x1b[31m\xff"), "'a?[31m?'");
  EXPECT_EQ(sqlite::quoted(std::string(1000, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST_F(MapFileTest, IntegrityCheckFindsDamageThatLoadingDoesNotSee) {
  ParkingMap map = sampleMap();
  save(map);
  EXPECT_TRUE(checkIntegrity(path_));
  {
    sqlite::Database database(path_, sqlite::Database::Mode::kReadWriteCreate);
    database.execute("CREATE INDEX extra ON slot (x0)");
    database.execute("PRAGMA writable_schema = ON");
    database.execute(
        "UPDATE sqlite_schema SET sql = 'CREATE INDEX extra ON slot (y0)' "
        "WHERE name = 'extra'");
  }
  EXPECT_TRUE(loadMap(path_));
  const Status status = checkIntegrity(path_);
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("is damaged"));
}

TEST_F(MapFileTest, DamagedBytesNeverCrash) {
  ParkingMap map = sampleMap();
  save(map);
  std::ifstream stream(path_, std::ios::binary);
  const std::string good((std::istreambuf_iterator<char>(stream)), {});
  Random random(5);
  int loaded = 0;
  constexpr int kRounds = 300;  // tools/fuzz_map.sh runs many more, under ASan
  for (int round = 0; round < kRounds; ++round) {
    std::string bad = good;
    const int hits = random.integer(1, 20);
    for (int i = 0; i < hits; ++i) bad[random.index(bad.size())] = static_cast<char>(random.bits());
    if (random.chance(0.2)) bad.resize(random.index(bad.size()));
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bad;
    const Result<ParkingMap> result = loadMap(path_);
    if (result) {
      ++loaded;
    } else {
      EXPECT_FALSE(result.error().message.empty());
    }
  }
  EXPECT_LT(loaded, kRounds);
}

TEST_F(MapFileTest, WhatAKilledWriterLeftIsNotPlayedIntoANewMap) {
  ParkingMap first = sampleMap(7);
  for (int k = 0; k < 400; ++k) {
    first.grid.add(GridLayer::kAvailability, {4.0 * k, 2.0}, SemanticClass::kFloor, 0.1F);
  }
  save(first);
  // In the middle of a save the journal holds what the file held before: a killed writer leaves it.
  const std::string journal = path_ + "-journal";
  const std::string left = path_ + ".left";
  {
    sqlite::Database database(path_, sqlite::Database::Mode::kReadWriteCreate);
    database.execute("PRAGMA cache_size = 2");
    database.execute("BEGIN IMMEDIATE");
    database.execute("UPDATE tile SET cells = randomblob(3000)");
    ASSERT_TRUE(std::filesystem::copy_file(journal, left));
    database.execute("ROLLBACK");
  }
  // The map alone is deleted then, and another one begun.
  std::filesystem::remove(path_);
  std::filesystem::rename(left, journal);
  ASSERT_TRUE(MapFile::open(path_));
  const Result<ParkingMap> empty = loadMap(path_);
  ASSERT_TRUE(empty) << empty.error().message;
  EXPECT_TRUE(empty->grid.tiles(GridLayer::kAvailability).empty());
  ParkingMap map = sampleMap(9);
  save(map);
  EXPECT_TRUE(checkIntegrity(path_));
  const Result<ParkingMap> loaded = loadMap(path_);
  ASSERT_TRUE(loaded) << loaded.error().message;
  expectSame(map, *loaded);
}

TEST_F(MapFileTest, KillDuringWritingLeavesAMapThatOpens) {
  // The first save is the parent's: a child may be killed before it reaches its own.
  ParkingMap first = sampleMap(99);
  save(first);
  constexpr int kRounds = 50;
  int complete = 0;
  for (int round = 0; round < kRounds; ++round) {
    killWhileSaving(static_cast<std::uint64_t>(round),
                    std::chrono::milliseconds(5 + 3 * round % 61));
    const Result<ParkingMap> loaded = loadMap(path_);
    ASSERT_TRUE(loaded) << loaded.error().message;
    complete += loaded->slots.size() == 6U ? 1 : 0;
  }
  EXPECT_EQ(complete, kRounds);
}

}  // namespace
}  // namespace parkade
