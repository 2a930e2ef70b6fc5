# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""End to end: a drive makes a map, a later one finds itself in it. Usage: saved_map_cli_test.py PARKADE"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PARKADE = sys.argv.pop(1)


def parkade(*arguments):
    return subprocess.run(
        [PARKADE, *map(str, arguments)], capture_output=True, text=True, timeout=1400
    )


class SavedMapTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="parkade_saved_map_")
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.sequence = cls.folder / "sequence"
        cls.first = cls.folder / "first"
        for arguments in [
            ["sim", "--route", "test3", "--fast", "--duration", 13, "--out", cls.sequence],
            ["run", cls.sequence, "--method", "fused", "--out", cls.first],
        ]:
            result = parkade(*arguments)
            assert result.returncode == 0, result.stderr

    def test_a_later_drive_finds_itself_and_is_told_in_the_maps_frame(self):
        later = self.folder / "later"
        result = parkade(
            "run", self.sequence, "--method", "fused", "--map", self.first, "--start", 3, "--final",
            "--out", later,
        )  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stderr, r"found in the saved map after \d+ m")
        errors = later / "errors.json"
        judged = parkade(
            "eval", later, self.sequence, "--in-map", self.first, self.sequence, "--json", errors
        )
        self.assertEqual(judged.returncode, 0, judged.stderr)
        figures = json.loads(errors.read_text(encoding="utf-8"))
        print(f"largest error {figures['ape']['max']:.3f} m, coverage {figures['coverage']:.2f}")
        self.assertLess(figures["ape"]["max"], 0.10)
        self.assertGreater(figures["coverage"], 0.1)
        self.assertLess(figures["coverage"], 0.8)
        # The health says why there were no poses before; in the end all are known.
        self.assertIn("not yet found in the saved map", (later / "health.csv").read_text())
        rows = [len((later / f"trajectory{n}.tum").read_text().splitlines()) for n in ["", "_final"]]
        self.assertLess(rows[0] + 20, rows[1])
        # Its own map lies in the same frame, and adds to the first one.
        garage = self.folder / "garage.db"
        merged = parkade("map", "merge", self.first / "map.db", later / "map.db", "--out", garage)
        self.assertEqual(merged.returncode, 0, merged.stderr)
        self.assertRegex(merged.stdout, r"[1-9]\d* seen again")
        self.assertEqual(parkade("map", "check", garage).returncode, 0)

    def test_another_garage_is_not_taken_for_it(self):
        other = self.folder / "other"
        made = parkade("sim", "--garage", "random", "--garage-seed", 7, "--route", "random", "--fast",
                       "--duration", 7, "--out", other)  # fmt: skip
        self.assertEqual(made.returncode, 0, made.stderr)
        out = self.folder / "lost"
        result = parkade("run", other, "--method", "fused", "--map", self.first, "--out", out)
        self.assertEqual(result.returncode, 1)
        self.assertIn("the car was not found in", result.stderr)
        self.assertTrue((out / "trajectory_vio.tum").exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
