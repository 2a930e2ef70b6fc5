#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Drives `parkade map` as a user does: sound, damaged and foreign files in, text and exit codes out."""

import json
import pathlib
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile
import unittest

PARKADE, SAMPLE_MAP = sys.argv.pop(1), sys.argv.pop(1)


def parkade(*arguments):
    return subprocess.run(
        [PARKADE, *map(str, arguments)], capture_output=True, text=True, timeout=120
    )


def parkade_map(*arguments):
    return parkade("map", *arguments)


class MapTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="parkade_map_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.map = self.folder / "map.db"
        subprocess.run([SAMPLE_MAP, str(self.map)], check=True, timeout=60)

    def change(self, sql):
        with sqlite3.connect(self.map) as database:
            database.execute(sql)

    def test_help_shows_an_example(self):
        result = parkade_map("--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("Examples:", result.stdout)
        for action in ("info", "check", "export", "merge"):
            text = parkade_map(action, "--help").stdout
            self.assertIn(f"Example:\n  parkade map {action} ", text)
        self.assertEqual(parkade_map().returncode, 2)
        self.assertEqual(parkade_map("export", self.map).returncode, 2)

    def test_info(self):
        out = self.folder / "info.json"
        result = parkade_map("info", self.map, "--json", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("6 (3 free, 3 occupied, 5 with a number)", result.stdout)
        self.assertIn("4 nodes over 3.0 m, 3 edges, 1 of them loops", result.stdout)
        description = json.loads(out.read_text(encoding="utf-8"))
        self.assertEqual(description["objects"], {"arrow": 1, "zone_marker": 1})
        self.assertGreater(description["layers"]["parking_lines"]["known_m2"], 0.5)

    def test_parkade_info_says_the_same(self):
        out = self.folder / "info.json"
        said = parkade_map("info", self.map).stdout
        for path in (self.map, self.folder):
            result = parkade("info", path, "--json", out)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stdout, said)
            self.assertEqual(json.loads(out.read_text(encoding="utf-8"))["slots"]["count"], 6)
        self.map.write_bytes(b"SQLite format 3\0 and nothing else")
        copy = self.folder / "map.sqlite"
        shutil.copy(self.map, copy)
        for path, named in ((self.map, self.map), (copy, copy), (self.folder, self.map)):
            result = parkade("info", path)
            self.assertEqual(result.returncode, 1)
            self.assertIn(f"parkade: {named}: ", result.stderr)
            self.assertIn("file is not a database", result.stderr)
        self.map.unlink()
        self.assertIn("there is no such map file", parkade("info", self.map).stderr)
        self.assertIn("not a sequence", parkade("info", self.folder).stderr)

    def test_check_finds_what_loads_and_is_wrong(self):
        result = parkade_map("check", self.map)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("sound", result.stdout)
        self.change("UPDATE slot SET x0=2.5, x1=0, x2=0, x3=2.5 WHERE id = 11")
        result = parkade_map("check", self.map)
        self.assertEqual(result.returncode, 1)
        self.assertIn("slots 10 and 11: 100 %", result.stdout)
        self.assertIn("1 fault", result.stderr)

    def test_check_finds_what_lies_too_far_away(self):
        self.change("UPDATE node SET px = 1e30 WHERE id = 3")
        self.change("UPDATE object SET position_sigma = -5 WHERE id = 4")
        self.change("UPDATE edge SET to_id = 1 WHERE to_id = 2")
        self.change("UPDATE tile SET x = 100000 WHERE layer = 0 AND x = 0 AND y = 0")
        result = parkade_map("check", self.map)
        self.assertEqual(result.returncode, 1)
        for words in (
            "tile (100000, 0) of layer parking_lines: lies at (320000, 0) m",
            "object 4: position_sigma of -5 m",
            "node 3: lies at (1e+30, ",
            "edge 1 to 1: joins a node to itself",
        ):
            self.assertIn(words, result.stdout)
        self.assertIn("4 faults", result.stderr)

    def test_a_run_folder_stands_for_its_map(self):
        out = self.folder / "out"
        for arguments in (("info",), ("check",), ("export", "--out", out)):
            result = parkade_map(arguments[0], self.folder, *arguments[1:])
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(str(self.map), result.stdout)
        result = parkade_map("merge", self.folder, self.folder, "--out", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{self.map}: 6 slots", result.stdout)

    def test_merge(self):
        later = self.folder / "later.db"
        shutil.copy(self.map, later)
        out = self.folder / "garage.db"
        result = parkade_map("merge", self.map, later, "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("6 slots (6 seen again, 0 new", result.stdout)
        self.assertIn("2 objects (2 seen again, 0 new)\n", result.stdout)
        self.assertEqual(parkade_map("check", out).returncode, 0)
        # A map of another world is refused, and what was written before stays.
        with sqlite3.connect(later) as database:
            database.execute("UPDATE slot SET " + ", ".join(f"x{i}=x{i}+1.2" for i in range(4)))
        before = out.read_bytes()
        result = parkade_map("merge", self.map, later, "--out", out)
        self.assertEqual(result.returncode, 1)
        self.assertIn("not of one world", result.stderr)
        self.assertIn("later.db", result.stderr)
        self.assertEqual(out.read_bytes(), before)

    def test_damaged_and_foreign_files(self):
        self.change("UPDATE slot SET probability_free = 7 WHERE id = 12")
        for action in ("info", "check", "export"):
            extra = ("--out", self.folder / "x") if action == "export" else ()
            result = parkade_map(action, self.map, *extra)
            self.assertEqual(result.returncode, 1)
            self.assertIn("slot 12: probability_free is 7", result.stderr)
            self.assertIn("map.db", result.stderr)
        text = self.folder / "letter.txt"
        text.write_text("Dear reader, this is no map. " * 100, encoding="utf-8")
        other = self.folder / "other.db"
        with sqlite3.connect(other) as database:
            database.execute("CREATE TABLE t (a)")
        empty = self.folder / "empty.db"
        empty.write_bytes(b"")
        bare = self.folder / "bare"  # a folder without a map
        bare.mkdir()
        for path in (text, other, empty, self.folder / "none.db", bare):
            result = parkade_map("info", path)
            self.assertEqual(result.returncode, 1, path)
            self.assertIn(str(path), result.stderr)
        cut = self.folder / "cut.db"
        cut.write_bytes(self.map.read_bytes()[:9000])
        self.assertEqual(parkade_map("info", cut).returncode, 1)

    def test_export(self):
        out = self.folder / "export"
        result = parkade_map("export", self.map, "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        names = {path.name for path in out.iterdir()}
        for layer in ("parking_lines", "availability", "road_markers", "zone_markers", "dynamic"):
            self.assertLessEqual({f"{layer}.pgm", f"{layer}.yaml"}, names)
        document = json.loads((out / "map.geojson").read_text(encoding="utf-8"))
        self.assertEqual(len(document["features"]), 8)
        png = (out / "map.png").read_bytes()
        self.assertEqual(png[:4], b"\x89PNG")
        self.assertGreater(struct.unpack(">I", png[16:20])[0], 100)
        # What cannot be exported is said before anything is written.
        none = self.folder / "none"
        self.change("UPDATE slot SET x1=60000, x2=60000 WHERE id = 15")
        result = parkade_map("export", self.map, "--out", none)
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"{self.map}: png: the map's picture would have", result.stderr)
        self.assertIn("take --metres-per-px", result.stderr)
        self.assertFalse(none.exists())
        self.change("UPDATE tile SET x = 1000000 WHERE layer = 0 AND x = 0 AND y = 0")
        result = parkade_map("export", self.map, "--out", none)
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"{self.map}: nav2: the map's picture would have", result.stderr)
        self.assertFalse(none.exists())

    def test_export_of_some_formats(self):
        few = self.folder / "few"
        self.assertEqual(
            parkade_map("export", self.map, "--out", few, "--format", "png,lanelet2").returncode, 0
        )
        self.assertEqual({path.name for path in few.iterdir()}, {"map.png", "map.osm"})


if __name__ == "__main__":
    unittest.main(verbosity=2)
