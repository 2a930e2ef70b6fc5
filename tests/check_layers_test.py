#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""tools/check_layers.py passes on the repository and fails on planted violations."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent


def check(root):
    """Runs the check; returns (exit code, stderr)."""
    done = subprocess.run(
        [sys.executable, ROOT / "tools" / "check_layers.py", "--root", root],
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, done.stderr


class CheckLayers(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        shutil.copytree(ROOT / "src" / "parkade" / "core", self.root / "src" / "parkade" / "core")

    def tearDown(self):
        self.folder.cleanup()

    def plant(self, room, line):
        path = self.root / "src" / "parkade" / room / "planted.cpp"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"// first line\n{line}\n", encoding="utf-8")

    def assert_refused(self, *words):
        code, message = check(self.root)
        self.assertEqual(code, 1)
        for word in words:
            self.assertIn(word, message)

    def test_repository_is_clean(self):
        code, message = check(ROOT)
        self.assertEqual(code, 0, message)

    def test_allowed_include_passes(self):
        self.plant("vio", '#include "parkade/core/time.hpp"')
        self.assertEqual(check(self.root)[0], 0)

    def test_lower_room_may_not_see_higher(self):
        self.plant("core", '#include "parkade/geometry/se3.hpp"')
        self.assert_refused("planted.cpp:2", "room 'core'", "geometry")

    def test_rooms_of_one_level_may_not_see_each_other(self):
        self.plant("tracking", '#include "parkade/vio/estimator.hpp"')
        self.assert_refused("room 'tracking'", "'vio'")

    def test_estimators_may_not_see_the_truth(self):
        for room in ("vio", "fusion", "localization", "pipeline"):
            self.plant(room, '#include "parkade/sim/garage.hpp"')
            self.assert_refused(f"room '{room}'", "'sim'")

    def test_third_party_stays_at_the_edges(self):
        self.plant("core", "#include <ceres/ceres.h>")
        self.assert_refused("ceres/ceres.h", "room 'core'")

    def test_unknown_room_and_relative_include(self):
        self.plant("utils", "")
        self.assert_refused("utils", "not a room")
        self.plant("core", '#include "../geometry/se3.hpp"')
        self.assert_refused("full path")


if __name__ == "__main__":
    unittest.main()
