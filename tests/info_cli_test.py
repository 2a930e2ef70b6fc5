#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Drives `parkade info` as a user does: a rig or a sequence in, text, JSON and exit codes out."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PARKADE = sys.argv.pop(1)
SOURCE = pathlib.Path(__file__).resolve().parent.parent
DATA = pathlib.Path(os.environ.get("PARKADE_TEST_DATA", SOURCE.parent / "shared" / "data"))


def info(*arguments):
    return subprocess.run(
        [PARKADE, "info", *map(str, arguments)], capture_output=True, text=True, timeout=120
    )


class InfoTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="parkade_info_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_help_shows_an_example(self):
        result = info("--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("Examples:", result.stdout)

    def test_rig(self):
        out = self.folder / "rig.json"
        result = info(SOURCE / "config" / "rigs" / "avp6.yaml", "--json", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("6 cameras", result.stdout)
        rig = json.loads(out.read_text(encoding="utf-8"))
        self.assertEqual(len(rig["cameras"]), 6)
        yaws = [camera["yaw_deg"] for camera in rig["cameras"]]
        self.assertTrue(any(abs(yaw) < 1.0 for yaw in yaws), yaws)  # one looks ahead
        self.assertGreater(rig["vehicle"]["wheelbase"], 2.0)

    def test_every_rig_of_the_repository(self):
        for path in sorted((SOURCE / "config" / "rigs").glob("*.yaml")):
            result = info(path)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("view deg", result.stdout)

    def test_what_is_no_sequence(self):
        for path, message in [
            (self.folder / "none", "no such file"),
            (self.folder, "expected a folder 'mav0'"),
            (self.folder / "none.yaml", "cannot open"),
        ]:
            result = info(path)
            self.assertEqual(result.returncode, 1)
            self.assertIn(message, result.stderr)
            self.assertEqual(result.stdout, "")

    def test_wrong_usage(self):
        self.assertEqual(info().returncode, 2)

    def test_euroc(self):
        sequence = DATA / "euroc_mh01_16s"
        if not sequence.is_dir():
            self.skipTest("no recordings: set PARKADE_TEST_DATA")
        out = self.folder / "info.json"
        result = info(sequence, "--json", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        for words in ["2 cameras", "319 frame sets", "20 Hz", "200 Hz IMU", "0 failed"]:
            self.assertIn(words, result.stdout)
        report = json.loads(out.read_text(encoding="utf-8"))
        self.assertEqual(report["frame_sets"], 319)
        self.assertFalse(report["failed"])

    def test_broken_stamps_fail(self):
        broken = DATA / "imu_broken_log" / "data.csv"
        if not broken.is_file():
            self.skipTest("no recordings: set PARKADE_TEST_DATA")
        euroc = DATA / "euroc_mh01_16s" / "mav0"
        for name in ["cam0", "imu0"]:
            (self.folder / "mav0" / name).mkdir(parents=True)
            shutil.copy(euroc / name / "sensor.yaml", self.folder / "mav0" / name)
        shutil.copy(euroc / "cam0" / "data.csv", self.folder / "mav0" / "cam0")
        shutil.copy(broken, self.folder / "mav0" / "imu0")
        result = info(self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("10488 stamps go backwards", result.stdout)
        self.assertIn("cam0 files", result.stdout)  # it goes on after the first failure


if __name__ == "__main__":
    unittest.main()
