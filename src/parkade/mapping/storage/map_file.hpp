// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "parkade/core/result.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// Version of the schema that this program writes and reads (docs/formats.md, "Map").
inline constexpr int kMapSchemaVersion = 1;

/// A map file open for writing. Every save is one transaction: whenever the program dies, the file
/// holds the last saved state, complete.
class MapFile {
 public:
  /// Makes a file, or opens one to be replaced by the first save. Fails where the path holds
  /// something that is not a Parkade map, or a map of a newer schema.
  static Result<MapFile> open(const std::string& path);
  MapFile(MapFile&&) noexcept;
  MapFile& operator=(MapFile&&) noexcept;
  ~MapFile();

  /// Writes the map: all of it the first time, then changed tiles only (and all vectors). Marks
  /// its tiles clean. On failure (full disk) the file keeps the state before.
  Status save(ParkingMap& map);

 private:
  struct Impl;
  explicit MapFile(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads a map. A file that is damaged, foreign, of another version or that holds values outside
/// their range gives an Error that says which; it never crashes and allocates no more than the
/// file's tiles do unpacked (a uniform one of 8 KB takes some 20 bytes of it).
Result<ParkingMap> loadMap(const std::string& path);

/// Writes a map into a new file, or over the one that is there. Where that fails, an old file is as
/// it was, and no new one is left to pass for an empty map.
Status saveMap(ParkingMap& map, const std::string& path);

/// Walks every page and index of the file, as loading does not. Fails with what is damaged.
Status checkIntegrity(const std::string& path);

}  // namespace parkade
