#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""The files of config/rigs/ are what the tools that made them make."""

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
            made = {path.name: path.read_text(encoding="utf-8") for path in pathlib.Path(folder).iterdir()}
        self.assertEqual(sorted(made), sorted(f"{name}.yaml" for name in names))
        for name, text in made.items():
            self.assertEqual(text, (RIGS / name).read_text(encoding="utf-8"), name)

    def test_make_rigs(self):
        self.check("make_rigs.py", ["avp6", "nuscenes6", "avm4"])


if __name__ == "__main__":
    unittest.main()
