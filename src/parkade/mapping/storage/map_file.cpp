// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/storage/map_file.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "parkade/mapping/storage/map_rows.hpp"
#include "parkade/mapping/storage/sqlite.hpp"

namespace parkade {
namespace {

using sqlite::Database;
using sqlite::namingRow;
using sqlite::SqliteError;
using sqlite::Statement;
using sqlite::Transaction;

constexpr int kApplicationId = 0x504b4d50;  // "PKMP"

constexpr const char* kSchema = R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE tile (layer INTEGER, x INTEGER, y INTEGER, cells BLOB NOT NULL,
                   PRIMARY KEY (layer, x, y)) WITHOUT ROWID;
CREATE TABLE slot (id INTEGER PRIMARY KEY, x0 REAL, y0 REAL, x1 REAL, y1 REAL, x2 REAL, y2 REAL,
                   x3 REAL, y3 REAL, corner_sigma REAL, shape INTEGER, number TEXT, zone TEXT,
                   probability_free REAL, observations INTEGER, last_seen_ns INTEGER);
CREATE TABLE object (id INTEGER PRIMARY KEY, class TEXT, x REAL, y REAL, z REAL, heading REAL,
                     position_sigma REAL, text TEXT, outline BLOB, observations INTEGER);
CREATE TABLE node (id INTEGER PRIMARY KEY, t_ns INTEGER, px REAL, py REAL, pz REAL, qx REAL,
                   qy REAL, qz REAL, qw REAL);
CREATE TABLE edge (from_id INTEGER, to_id INTEGER, kind INTEGER, px REAL, py REAL, pz REAL,
                   qx REAL, qy REAL, qz REAL, qw REAL, information BLOB);
)sql";

std::int64_t pragma(const Database& database, const char* name) {
  Statement statement(database, fmt::format("PRAGMA {}", name));
  return statement.step() ? statement.integer(0) : 0;
}

// Throws unless the file is a map of this version.
void checkIdentity(const Database& database, const std::string& path) {
  if (pragma(database, "application_id") != kApplicationId) {
    throw SqliteError(path + ": this is no Parkade map");
  }
  const std::int64_t version = pragma(database, "user_version");
  if (version != kMapSchemaVersion) {
    throw SqliteError(fmt::format("{}: the map has schema version {}, this program reads {}", path,
                                  version, kMapSchemaVersion));
  }
  // One made to harm could have a reader work for ever.
  Statement odd(database, "SELECT count(*) FROM sqlite_master WHERE type IN ('view', 'trigger')");
  if (odd.step() && odd.integer(0) > 0) {
    throw SqliteError(path + ": holds views or triggers, as no map does");
  }
}

// A value of table meta, empty where the key is not there.
std::string metaOf(const Database& database, const char* key) {
  Statement row(database, "SELECT value FROM meta WHERE key = ?");
  row.bind(1, std::string_view(key));
  std::string value;
  if (!row.step()) return value;
  namingRow([&] { return fmt::format("meta, key '{}'", key); }, [&] { value = row.text(0); });
  return value;
}

double resolutionOf(const Database& database) {
  const std::string text = metaOf(database, "resolution");
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= 1e-3 && value <= 10.0)) {
    throw SqliteError(fmt::format("meta, key 'resolution': {} is no number from 0.001 to 10 m",
                                  sqlite::quoted(text)));
  }
  return value;
}

// Makes an empty map beside its name and renames it: a new file is a readable map from the start.
void createEmpty(const std::string& path) {
  const std::string temporary = path + ".new";
  std::error_code code;
  std::filesystem::remove(temporary, code);
  {
    Database database(temporary, Database::Mode::kReadWriteCreate);
    // Rows of a table without row ids keep a quarter of a page to themselves; what is longer takes
    // pages of its own. In pages of 4 KiB that is most tiles, and the file twice as large.
    database.execute("PRAGMA page_size = 16384");
    Transaction transaction(database);
    database.execute(kSchema);
    database.execute(fmt::format("PRAGMA application_id = {}", kApplicationId));
    database.execute(fmt::format("PRAGMA user_version = {}", kMapSchemaVersion));
    database.execute("INSERT INTO meta VALUES ('resolution', '0.05')");
    transaction.commit();
  }
  // What a killed writer left beside a map that was deleted since would be played back into this
  // one.
  for (const char* ending : {"-journal", "-wal", "-shm"}) {
    std::filesystem::remove(path + ending, code);
  }
  std::filesystem::rename(temporary, path, code);
  if (code) throw SqliteError(fmt::format("{}: cannot be created: {}", path, code.message()));
}

}  // namespace

struct MapFile::Impl {
  std::string path;
  Database database;
  bool complete = false;  // the file holds the map of the last save
  using TileKey = std::pair<GridLayer, LayeredGrid::TileIndex>;
  std::set<TileKey> tiles;  // in the file
};

MapFile::MapFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MapFile::MapFile(MapFile&&) noexcept = default;
MapFile& MapFile::operator=(MapFile&&) noexcept = default;
MapFile::~MapFile() = default;

Result<MapFile> MapFile::open(const std::string& path) {
  try {
    std::error_code code;
    if (!std::filesystem::exists(path, code)) createEmpty(path);
    auto impl = std::unique_ptr<Impl>(
        new Impl{path, Database(path, Database::Mode::kReadWriteCreate), false, {}});
    checkIdentity(impl->database, path);
    return MapFile(std::move(impl));
  } catch (const SqliteError& error) {
    return Error{error.what()};
  }
}

Status MapFile::save(ParkingMap& map) {
  try {
    Database& database = impl_->database;
    Transaction transaction(database);
    database.execute(
        "DELETE FROM meta; DELETE FROM slot; DELETE FROM object; DELETE FROM node; "
        "DELETE FROM edge");
    if (!impl_->complete) {
      database.execute("DELETE FROM tile");
      impl_->tiles.clear();
    }
    writeRows(database, map);
    std::set<Impl::TileKey> present;
    Statement put(database, "INSERT OR REPLACE INTO tile VALUES (?, ?, ?, ?)");
    for (const GridLayer layer : kGridLayers) {
      for (const auto& [at, tile] : map.grid.tiles(layer)) {
        const Impl::TileKey key{layer, at};
        present.insert(key);
        if (!tile.dirty && impl_->tiles.count(key) > 0) continue;
        const std::vector<std::uint8_t> packed = packTile(tile);
        put.bind(1, static_cast<std::int64_t>(layer)).bind(2, std::int64_t{at.x});
        put.bind(3, std::int64_t{at.y}).bind(4, std::span<const std::uint8_t>(packed)).run();
      }
    }
    Statement drop(database, "DELETE FROM tile WHERE layer = ? AND x = ? AND y = ?");
    for (const Impl::TileKey& key : impl_->tiles) {
      if (present.count(key) > 0) continue;
      drop.bind(1, static_cast<std::int64_t>(key.first));
      drop.bind(2, std::int64_t{key.second.x}).bind(3, std::int64_t{key.second.y}).run();
    }
    transaction.commit();
    impl_->tiles = std::move(present);
    impl_->complete = true;
    map.grid.markClean();
    return {};
  } catch (const SqliteError& error) {
    impl_->complete = false;  // the next save writes everything
    return Error{error.what()};
  }
}

Status saveMap(ParkingMap& map, const std::string& path) {
  std::error_code code;
  const bool is_new = !std::filesystem::exists(path, code);
  Status saved;
  {
    Result<MapFile> file = MapFile::open(path);
    saved = file ? file->save(map) : Status(file.error());
  }
  if (!saved && is_new) std::filesystem::remove(path, code);
  return saved;
}

Result<ParkingMap> loadMap(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) {
    return Error{path + ": there is no such map file"};
  }
  try {
    const Database database(path, Database::Mode::kRead);
    checkIdentity(database, path);
    ParkingMap map;
    map.grid = LayeredGrid(resolutionOf(database));
    map.name = metaOf(database, "name");
    readGrid(database, map);
    readSlots(database, map);
    readObjects(database, map);
    readGraph(database, map);
    return map;
  } catch (const SqliteError& error) {
    const std::string message = error.what();
    return Error{message.rfind(path, 0) == 0 ? message : path + ": " + message};
  }
}

Status checkIntegrity(const std::string& path) {
  try {
    const Database database(path, Database::Mode::kRead);
    checkIdentity(database, path);
    Statement row(database, "PRAGMA integrity_check(1)");
    const std::string verdict = row.step() ? row.text(0) : "no answer";
    if (verdict != "ok") return Error{fmt::format("{}: is damaged: {}", path, verdict)};
    return {};
  } catch (const SqliteError& error) {
    return Error{error.what()};
  }
}

}  // namespace parkade
