// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/storage/sqlite.hpp"

// Inside of map_file.cpp: a map's parts as rows of its tables (docs/formats.md). All throw
// sqlite::SqliteError, reading ones also where a value is none that a map may have.

namespace parkade {

/// A tile's cells as its blob holds them: compressed log-odds, then classes.
std::vector<std::uint8_t> packTile(const LayeredGrid::Tile& tile);

/// Everything but the tiles.
void writeRows(const sqlite::Database& database, const ParkingMap& map);

void readGrid(const sqlite::Database& database, ParkingMap& map);
void readSlots(const sqlite::Database& database, ParkingMap& map);
void readObjects(const sqlite::Database& database, ParkingMap& map);
void readGraph(const sqlite::Database& database, ParkingMap& map);

}  // namespace parkade
