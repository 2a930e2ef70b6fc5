#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""The files of config/rigs/ are what the tools that made them make."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
RIGS = ROOT / "config" / "rigs"


def run(tool, *arguments):
    """Runs a tool of tools/; raises with its output where it fails."""
    done = subprocess.run(
        [sys.executable, ROOT / "tools" / tool, *arguments],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise AssertionError(f"{tool}: exit code {done.returncode}\n{done.stdout}{done.stderr}")


class RigTools(unittest.TestCase):
    def check(self, tool, names, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            run(tool, "--out", folder, *arguments)
            paths = pathlib.Path(folder).iterdir()
            made = {path.name: path.read_text(encoding="utf-8") for path in paths}
        self.assertEqual(sorted(made), sorted(f"{name}.yaml" for name in names))
        for name, text in made.items():
            self.assertEqual(text, (RIGS / name).read_text(encoding="utf-8"), name)

    def test_make_rigs(self):
        self.check("make_rigs.py", ["avp6", "nuscenes6", "avm4"])

    def test_convert_rigs(self):
        data = pathlib.Path(os.environ.get("PARKADE_TEST_DATA", ROOT.parent / "shared" / "data"))
        if not data.is_dir():
            self.skipTest(f"{data} is absent")
        names = ["garage_fisheye_real", "garage_fisheye_sim", "roecs_fisheye_real", "euroc"]
        self.check("convert_rigs.py", names, "--data", str(data))


if __name__ == "__main__":
    unittest.main()
