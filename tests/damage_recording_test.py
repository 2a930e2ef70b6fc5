#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""tools/damage_recording.py makes the faults that it is told, and leaves the rest as it was."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
    from PIL import Image
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(0)

TOOL = pathlib.Path(__file__).resolve().parent.parent / "tools" / "damage_recording.py"
FIRST = 10**18
STEP = 100_000_000  # ns between pictures


def make_recording(folder):
    """Two cameras of 40 pictures each, told apart by their brightness."""
    for camera in ("cam0", "cam1"):
        data = folder / "mav0" / camera / "data"
        data.mkdir(parents=True)
        rows = ["#timestamp [ns],filename"]
        for i in range(40):
            stamp = FIRST + i * STEP
            Image.fromarray(np.full((24, 32), 20 + 2 * i, np.uint8)).save(data / f"{stamp}.png")
            rows.append(f"{stamp},{stamp}.png")
        (data.parent / "data.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    for sensor in ("imu0", "wheel0"):
        (folder / "mav0" / sensor).mkdir()
        values = "0.1,0,0,0,0,9.8" if sensor == "imu0" else "1,2"
        rows = ["#t"] + [f"{FIRST + i * STEP // 10},{values}" for i in range(400)]
        table = folder / "mav0" / sensor / "data.csv"
        table.write_text("\n".join(rows) + "\n", encoding="utf-8")
    (folder / "truth").mkdir()
    (folder / "truth" / "map.yaml").write_text("the truth", encoding="utf-8")
    (folder / "rig.yaml").write_text("the rig", encoding="utf-8")


def rows_of(folder, sensor):
    lines = (folder / "mav0" / sensor / "data.csv").read_text(encoding="utf-8").splitlines()
    return [line.split(",") for line in lines[1:]]


def brightness(folder, camera, i):
    name = rows_of(folder, camera)[i][1]
    return float(np.mean(np.asarray(Image.open(folder / "mav0" / camera / "data" / name))))


class DamageRecording(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.sequence = pathlib.Path(folder.name) / "sequence"
        self.out = pathlib.Path(folder.name) / "out"
        make_recording(self.sequence)

    def tool(self, *faults):
        more = [part for fault in faults for part in ("--fault", fault)]
        return subprocess.run(
            [sys.executable, TOOL, self.sequence, "--out", self.out, *more],
            capture_output=True, text=True, check=False,
        )  # fmt: skip

    def damage(self, *faults):
        done = self.tool(*faults)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_what_is_not_at_fault_stays(self):
        self.damage("blind:begin=1,seconds=2")
        for camera in ("cam0", "cam1"):
            rows = rows_of(self.out, camera)
            self.assertEqual(len(rows), 20)
            self.assertEqual([int(row[0]) for row in rows[9:11]], [FIRST + 9 * STEP, FIRST + 30 * STEP])
        for sensor in ("imu0", "wheel0"):
            self.assertEqual(rows_of(self.out, sensor), rows_of(self.sequence, sensor))
        for name in ("truth/map.yaml", "rig.yaml"):
            self.assertEqual((self.out / name).read_bytes(), (self.sequence / name).read_bytes())
        self.assertEqual(brightness(self.out, "cam0", 9), 38.0)

    def test_pictures_are_changed_in_their_time_and_camera_alone(self):
        self.damage("black:begin=1,seconds=1,camera=cam1", "frozen:begin=2,seconds=1,camera=cam0")
        self.assertEqual(brightness(self.out, "cam1", 10), 0.0)
        self.assertEqual(brightness(self.out, "cam1", 20), 60.0)
        self.assertEqual(brightness(self.out, "cam0", 10), 40.0)
        self.assertEqual(brightness(self.out, "cam0", 29), 60.0)
        self.assertEqual(brightness(self.out, "cam0", 30), 80.0)

    def test_light_and_dirt(self):
        self.damage("flicker:gain=2", "dirt:camera=cam1,size=0.5")
        gains = [brightness(self.out, "cam0", i) / (20.0 + 2 * i) for i in range(40)]
        self.assertGreater(max(gains) - min(gains), 0.3)
        self.assertTrue(all(0.45 < gain < 2.1 for gain in gains))
        name = rows_of(self.out, "cam1")[0][1]
        stained = np.asarray(Image.open(self.out / "mav0" / "cam1" / "data" / name), dtype=float)
        self.assertGreater(stained.max() - stained.min(), 30.0)

    def test_lost_pictures_and_stamps(self):
        self.damage("drop:share=0.5", "gone:camera=cam1,begin=2", "late:ms=5")
        rows = rows_of(self.out, "cam0")
        self.assertTrue(10 < len(rows) < 30)
        self.assertEqual((int(rows[0][0]) - FIRST) % STEP, 5_000_000)
        self.assertLess(int(rows_of(self.out, "cam1")[-1][0]), FIRST + 20 * STEP)

    def test_silent_sensors(self):
        self.damage("imu_gap:begin=1,seconds=1", "no_wheels")
        self.assertEqual(len(rows_of(self.out, "imu0")), 300)
        self.assertFalse((self.out / "mav0" / "wheel0").exists())

    def test_inertial_units_that_are_not_as_told(self):
        self.damage("imu_scale:share=0.5", "imu_bias:begin=1,gyro=1,accel=0", "imu_broken:count=7")
        readings = np.array(rows_of(self.out, "imu0"), dtype=float)[:, 1:]
        early, late = np.median(readings[:100], axis=0), np.median(readings[100:], axis=0)
        np.testing.assert_allclose(early, [0.15, 0, 0, 0, 0, 14.7])
        np.testing.assert_allclose(late, [1.15, 1, 1, 0, 0, 14.7])
        usual = np.where(np.arange(400)[:, None] < 100, early, late)
        self.assertEqual(np.count_nonzero(np.abs(readings - usual).max(axis=1) > 1e-9), 7)
        self.assertEqual(rows_of(self.out, "wheel0"), rows_of(self.sequence, "wheel0"))

    def test_an_inertial_unit_that_is_turned_measures_the_same_lengths(self):
        self.damage("imu_turned:deg=30")
        reading = np.array(rows_of(self.out, "imu0")[0][1:], dtype=float)
        self.assertAlmostEqual(np.linalg.norm(reading[:3]), 0.1)
        self.assertAlmostEqual(np.linalg.norm(reading[3:]), 9.8)
        self.assertLess(reading[5], 8.6)

    def test_wrong_arguments_are_named(self):
        for fault, word in [
            ("blnd", "unknown fault 'blnd'"),
            ("blind:start=1", "blind has no 'start'"),
            ("blind:begin=soon", "'soon' is no number"),
            ("gone:camera=cam7", "no camera 'cam7'"),
        ]:
            done = self.tool(fault)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(word, done.stderr)
            self.assertFalse(self.out.exists())
        self.out.mkdir()
        self.assertIn("is there already", self.tool("no_wheels").stderr)


if __name__ == "__main__":
    unittest.main()
