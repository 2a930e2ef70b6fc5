// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/storage/map_rows.hpp"

#include <fmt/core.h>
#include <zstd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <set>
#include <span>
#include <utility>

namespace parkade {
namespace {

using sqlite::Database;
using sqlite::namingRow;
using sqlite::SqliteError;
using sqlite::Statement;

constexpr int kCells = LayeredGrid::kTileCells * LayeredGrid::kTileCells;
constexpr std::size_t kTileBytes = 2 * kCells;  // log-odds of all cells, then their classes
constexpr std::int32_t kFarthestTile = 1 << 20;
static_assert(std::endian::native == std::endian::little, "blobs are little-endian");

LayeredGrid::Tile unpackTile(std::span<const std::uint8_t> packed) {
  std::vector<std::uint8_t> raw(kTileBytes);
  const std::size_t size = ZSTD_decompress(raw.data(), raw.size(), packed.data(), packed.size());
  if (ZSTD_isError(size) != 0 || size != kTileBytes) {
    throw SqliteError("is damaged: its cells do not unpack");
  }
  LayeredGrid::Tile tile;
  tile.dirty = false;
  for (std::size_t i = 0; i < kCells; ++i) {
    if (raw[kCells + i] >= kNumSemanticClasses) {
      throw SqliteError(fmt::format("its cells hold the unknown class {}", raw[kCells + i]));
    }
    tile.cells[i].log_odds = static_cast<std::int8_t>(raw[i]);
    tile.cells[i].semantic_class = static_cast<SemanticClass>(raw[kCells + i]);
  }
  return tile;
}

std::span<const std::uint8_t> bytesOf(const void* data, std::size_t size) {
  return {static_cast<const std::uint8_t*>(data), size};
}

void bindPose(Statement& statement, int first, const SE3& T) {
  const Eigen::Vector3d& p = T.translation();
  const Eigen::Quaterniond& q = T.rotation().quaternion();
  const double values[7] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
  for (int i = 0; i < 7; ++i) statement.bind(first + i, values[i]);
}

SE3 poseAt(const Statement& row, int first) {
  const Eigen::Quaterniond q(row.real(first + 6), row.real(first + 3), row.real(first + 4),
                             row.real(first + 5));
  constexpr double kTolerance = 1e-6;
  if (std::abs(q.norm() - 1.0) > kTolerance) {
    throw SqliteError(
        fmt::format("the quaternion (qx to qw) has the norm {}, expected 1", q.norm()));
  }
  return {SO3(q), {row.real(first), row.real(first + 1), row.real(first + 2)}};
}

template <class Enum>
Enum enumAt(const Statement& row, int column, int count, const char* what) {
  const std::int64_t value = row.integer(column);
  if (value < 0 || value >= count) {
    throw SqliteError(fmt::format("{} is {}, expected 0 to {}", what, value, count - 1));
  }
  return static_cast<Enum>(value);
}

SemanticClass classNamed(const std::string& name) {
  for (std::size_t i = 0; i < kSemanticClassNames.size(); ++i) {
    if (kSemanticClassNames[i] == name) return static_cast<SemanticClass>(i);
  }
  throw SqliteError(fmt::format("unknown class {}", sqlite::quoted(name)));
}

MapSlot slotAt(const Statement& row) {
  MapSlot s;
  s.id = row.integer(0);
  for (int i = 0; i < 4; ++i) {
    s.corners[static_cast<std::size_t>(i)] = {row.real(1 + 2 * i), row.real(2 + 2 * i)};
  }
  s.corner_sigma = row.real(9);
  s.shape = enumAt<SlotShape>(row, 10, 3, "shape");
  s.number = row.text(11);
  s.zone = row.text(12);
  s.probability_free = row.real(13);
  if (s.probability_free < 0.0 || s.probability_free > 1.0) {
    throw SqliteError(fmt::format("probability_free is {}, expected 0 to 1", s.probability_free));
  }
  s.observations = row.integer(14);
  s.last_seen_ns = row.integer(15);
  return s;
}

std::vector<Eigen::Vector2d> outlineAt(const Statement& row, int column) {
  const std::span<const std::uint8_t> bytes = row.blob(column);
  constexpr std::size_t kPoint = sizeof(Eigen::Vector2d);
  if (bytes.size() % kPoint != 0) {
    throw SqliteError(
        fmt::format("outline has {} bytes, expected a multiple of {}", bytes.size(), kPoint));
  }
  std::vector<Eigen::Vector2d> outline;
  for (std::size_t at = 0; at < bytes.size(); at += kPoint) {
    double xy[2];
    std::memcpy(xy, bytes.data() + at, sizeof(xy));
    outline.emplace_back(xy[0], xy[1]);
    if (!outline.back().allFinite()) {
      throw SqliteError(fmt::format("corner {} of outline is not finite", outline.size() - 1));
    }
  }
  return outline;
}

MapObject objectAt(const Statement& row) {
  MapObject o;
  o.id = row.integer(0);
  o.semantic_class = classNamed(row.text(1));
  o.position = {row.real(2), row.real(3), row.real(4)};
  o.heading = row.real(5);
  o.position_sigma = row.real(6);
  o.text = row.text(7);
  o.outline = outlineAt(row, 8);
  o.observations = row.integer(9);
  return o;
}

PoseGraphEdge edgeAt(const Statement& row, const std::set<std::int64_t>& nodes) {
  PoseGraphEdge e;
  e.from = row.integer(0);
  e.to = row.integer(1);
  for (const std::int64_t id : {e.from, e.to}) {
    if (nodes.count(id) == 0) throw SqliteError(fmt::format("node {} is missing", id));
  }
  e.kind = enumAt<EdgeKind>(row, 2, 2, "kind");
  e.T_from_to = poseAt(row, 3);
  const std::span<const std::uint8_t> information = row.blob(10);
  if (information.size() != sizeof(Matrix6d)) {
    throw SqliteError(
        fmt::format("information has {} bytes, expected {}", information.size(), sizeof(Matrix6d)));
  }
  std::memcpy(e.information.data(), information.data(), information.size());
  if (!e.information.allFinite()) throw SqliteError("information is not finite");
  return e;
}

}  // namespace

std::vector<std::uint8_t> packTile(const LayeredGrid::Tile& tile) {
  std::vector<std::uint8_t> raw(kTileBytes);
  for (std::size_t i = 0; i < kCells; ++i) {
    raw[i] = static_cast<std::uint8_t>(tile.cells[i].log_odds);
    raw[kCells + i] = static_cast<std::uint8_t>(tile.cells[i].semantic_class);
  }
  std::vector<std::uint8_t> packed(ZSTD_compressBound(kTileBytes));
  constexpr int kLevel = 3;
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), kLevel);
  if (ZSTD_isError(size) != 0) throw SqliteError("a tile cannot be compressed");
  packed.resize(size);
  return packed;
}

void writeRows(const Database& database, const ParkingMap& map) {
  Statement meta(database, "INSERT INTO meta VALUES (?, ?)");
  meta.bind(1, "name").bind(2, map.name).run();
  meta.bind(1, "resolution").bind(2, fmt::format("{}", map.grid.resolution())).run();
  meta.bind(1, "frame").bind(2, "local metric, x and y in the ground plane, z up, metres").run();

  Statement slot(database, "INSERT INTO slot VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
  for (const MapSlot& s : map.slots) {
    slot.bind(1, s.id);
    for (int i = 0; i < 4; ++i) {
      slot.bind(2 + 2 * i, s.corners[static_cast<std::size_t>(i)].x());
      slot.bind(3 + 2 * i, s.corners[static_cast<std::size_t>(i)].y());
    }
    slot.bind(10, s.corner_sigma).bind(11, static_cast<std::int64_t>(s.shape));
    slot.bind(12, s.number).bind(13, s.zone).bind(14, s.probability_free);
    slot.bind(15, s.observations).bind(16, s.last_seen_ns).run();
  }
  Statement object(database, "INSERT INTO object VALUES (?,?,?,?,?,?,?,?,?,?)");
  for (const MapObject& o : map.objects) {
    object.bind(1, o.id).bind(2, kSemanticClassNames[static_cast<std::size_t>(o.semantic_class)]);
    object.bind(3, o.position.x()).bind(4, o.position.y()).bind(5, o.position.z());
    object.bind(6, o.heading).bind(7, o.position_sigma).bind(8, o.text);
    object.bind(9, bytesOf(o.outline.data(), o.outline.size() * sizeof(Eigen::Vector2d)));
    object.bind(10, o.observations).run();
  }
  Statement node(database, "INSERT INTO node VALUES (?,?,?,?,?,?,?,?,?)");
  for (const PoseGraphNode& n : map.nodes) {
    node.bind(1, n.id).bind(2, n.t_ns);
    bindPose(node, 3, n.T_world_vehicle);
    node.run();
  }
  Statement edge(database, "INSERT INTO edge VALUES (?,?,?,?,?,?,?,?,?,?,?)");
  for (const PoseGraphEdge& e : map.edges) {
    edge.bind(1, e.from).bind(2, e.to).bind(3, static_cast<std::int64_t>(e.kind));
    bindPose(edge, 4, e.T_from_to);
    edge.bind(11, bytesOf(e.information.data(), sizeof(Matrix6d))).run();
  }
}

void readGrid(const Database& database, ParkingMap& map) {
  Statement row(database, "SELECT layer, x, y, cells FROM tile");
  const auto name = [&] {
    return fmt::format("tile ({}, {}) of layer {}", row.shown(1), row.shown(2), row.shown(0));
  };
  while (row.step()) {
    namingRow(name, [&] {
      const auto layer = enumAt<GridLayer>(row, 0, kNumGridLayers, "layer");
      const std::int64_t x = row.integer(1);
      const std::int64_t y = row.integer(2);
      if (x < -kFarthestTile || x > kFarthestTile || y < -kFarthestTile || y > kFarthestTile) {
        throw SqliteError(fmt::format("x and y may be {} at most", kFarthestTile));
      }
      map.grid.setTile(layer, {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
                       unpackTile(row.blob(3)));
    });
  }
}

void readSlots(const Database& database, ParkingMap& map) {
  Statement row(database, "SELECT * FROM slot ORDER BY id");
  while (row.step()) {
    namingRow([&] { return "slot " + row.shown(0); }, [&] { map.slots.push_back(slotAt(row)); });
  }
}

void readObjects(const Database& database, ParkingMap& map) {
  Statement row(database, "SELECT * FROM object ORDER BY id");
  while (row.step()) {
    namingRow([&] { return "object " + row.shown(0); },
              [&] { map.objects.push_back(objectAt(row)); });
  }
}

void readGraph(const Database& database, ParkingMap& map) {
  Statement node(database, "SELECT * FROM node ORDER BY id");
  std::set<std::int64_t> ids;
  while (node.step()) {
    namingRow([&] { return "node " + node.shown(0); },
              [&] {
                map.nodes.push_back({node.integer(0), node.integer(1), poseAt(node, 2)});
                ids.insert(map.nodes.back().id);
              });
  }
  Statement edge(database, "SELECT * FROM edge ORDER BY rowid");
  while (edge.step()) {
    namingRow([&] { return fmt::format("edge {} to {}", edge.shown(0), edge.shown(1)); },
              [&] { map.edges.push_back(edgeAt(edge, ids)); });
  }
}

}  // namespace parkade
