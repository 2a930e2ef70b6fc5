// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes a small map with something of everything: sample_map PATH. For tests of the program.
#include "parkade/mapping/map_test_support.hpp"
#include "parkade/mapping/storage/map_file.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  parkade::ParkingMap map = parkade::testing::sampleMap();
  parkade::Result<parkade::MapFile> file = parkade::MapFile::open(argv[1]);
  return file && file->save(map) ? 0 : 1;
}
