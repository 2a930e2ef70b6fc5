#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Drives `parkade eval` as a user does: files in, table, JSON, SVG and exit codes out."""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

PARKADE = sys.argv.pop(1)
SOURCE = pathlib.Path(__file__).resolve().parent.parent
DATA = pathlib.Path(os.environ.get("PARKADE_TEST_DATA", SOURCE.parent / "shared" / "data"))
TRAJECTORIES = DATA / "trajectories"


def evaluate(*arguments):
    return subprocess.run(
        [PARKADE, "eval", *map(str, arguments)], capture_output=True, text=True, timeout=120
    )


def drive(count=200, step_s=0.1, start_s=100.0, scale=1.0, yaw=0.0, offset=(0.0, 0.0, 0.0)):
    """TUM rows of a winding drive at 0.5 m per pose, moved by scale, yaw about z and offset."""
    x = y = heading = 0.0
    rows = []
    for i in range(count):
        px = scale * (math.cos(yaw) * x - math.sin(yaw) * y) + offset[0]
        py = scale * (math.sin(yaw) * x + math.cos(yaw) * y) + offset[1]
        half = 0.5 * (heading + yaw)
        rows.append(
            f"{start_s + i * step_s:.6f} {px:.12f} {py:.12f} {offset[2]:.12f} "
            f"0 0 {math.sin(half):.15f} {math.cos(half):.15f}"
        )
        x += 0.5 * math.cos(heading)
        y += 0.5 * math.sin(heading)
        heading += 0.06 * math.sin(0.05 * i)
    return rows


def kitti(count):
    return [f"1 0 0 {0.1 * i * i} 0 1 0 0 0 0 1 {0.8 * i}" for i in range(count)]


class EvalTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="parkade_eval_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, rows):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(rows) + "\n", encoding="utf-8")
        return path

    def figures(self, *arguments):
        """The JSON of a run that must succeed."""
        path = self.folder / "figures.json"
        result = evaluate(*arguments, "--json", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(path.read_text(encoding="utf-8"))

    def refused(self, code, *arguments):
        """The message of a run that must fail with this code."""
        result = evaluate(*arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertEqual(result.stdout if code == 1 else "", "")
        return result.stderr + (result.stdout if code == 2 else "")

    def assert_near(self, value, expected, relative):
        self.assertLessEqual(abs(value - expected), relative * abs(expected), f"{value!r}")

    # Published figures

    @unittest.skipUnless(TRAJECTORIES.is_dir(), f"no test data in {TRAJECTORIES}")
    def test_kitti_orb(self):
        f = self.figures(TRAJECTORIES / "KITTI_00_ORB.txt", TRAJECTORIES / "KITTI_00_gt.txt")
        self.assert_near(f["ape"]["rmse"], 1.3034497145650266, 1e-9)
        self.assert_near(f["rpe"]["rmse"], 0.22626134329310163, 1e-6)
        self.assertEqual(f["matched"], 4541)
        self.assertEqual(f["coverage"], 1.0)
        # The authors of ORB-SLAM2 report 0.70 % and 0.25 deg per 100 m.
        self.assertEqual(f"{f['drift_percent']:.2f}", "0.70")
        self.assertEqual(f"{100 * f['drift']['deg_per_m']:.2f}", "0.25")

    @unittest.skipUnless(TRAJECTORIES.is_dir(), f"no test data in {TRAJECTORIES}")
    def test_kitti_sptam(self):
        f = self.figures(TRAJECTORIES / "KITTI_00_SPTAM.txt", TRAJECTORIES / "KITTI_00_gt.txt")
        self.assert_near(f["ape"]["rmse"], 3.738487907582613, 1e-9)

    @unittest.skipUnless(TRAJECTORIES.is_dir(), f"no test data in {TRAJECTORIES}")
    def test_fr2_desk(self):
        f = self.figures(
            TRAJECTORIES / "fr2_desk_ORB.txt", TRAJECTORIES / "fr2_desk_groundtruth.txt"
        )
        self.assertEqual(f"{f['ape']['rmse']:.6f}", "0.008119")
        self.assertEqual(f["matched"], 2174)

    @unittest.skipUnless((DATA / "euroc_mh01_16s").is_dir(), f"no test data in {DATA}")
    def test_sequence_folder_as_reference(self):
        sequence = DATA / "euroc_mh01_16s"
        f = self.figures(sequence, sequence)
        self.assertLess(f["ape"]["max"], 1e-9)
        self.assertGreater(f["matched"], 3000)

    # Known answers

    def test_alignments(self):
        reference = self.write("reference.tum", drive())
        moved = self.write("moved.tum", drive(scale=1.1, yaw=0.7, offset=(5.0, -3.0, 1.0)))
        similar = self.figures(moved, reference, "--align", "sim3")
        self.assertLess(similar["ape"]["max"], 1e-6)
        self.assert_near(similar["alignment"]["scale"], 1 / 1.1, 1e-9)
        self.assertGreater(self.figures(moved, reference)["ape"]["rmse"], 0.5)
        turned = self.write("turned.tum", drive(yaw=0.7, offset=(5.0, -3.0, 1.0)))
        for align in ("se3", "yaw", "origin"):
            f = self.figures(turned, reference, "--align", align)
            self.assertLess(f["ape"]["max"], 1e-6, align)
            self.assertLess(f["ape_rotation_deg"]["max"], 1e-4, align)
        f = self.figures(turned, reference, "--align", "none")
        self.assert_near(f["ape_rotation_deg"]["mean"], math.degrees(0.7), 1e-9)
        self.assert_near(f["ape_heading_deg"]["mean"], math.degrees(0.7), 1e-9)

    def test_json_has_the_schema(self):
        path = self.write("t.tum", drive())
        f = self.figures(path, path)
        for metric in ("ape", "ape_rotation_deg", "rpe"):
            for field in ("rmse", "mean", "median", "p95", "max"):
                self.assertIsInstance(f[metric][field], float)
        for name in ("drift_percent", "coverage"):
            self.assertIsInstance(f[name], float)
        self.assertEqual(f["matched"], 200)

    def test_rpe_units(self):
        reference = self.write("reference.tum", drive())
        scaled = self.write("scaled.tum", drive(scale=1.02))
        for unit, delta, pairs in (("m", 5, 18), ("s", 1, 20), ("f", 10, 19)):
            f = self.figures(scaled, reference, "--rpe-unit", unit, "--rpe-delta", delta)
            self.assertEqual(f["rpe"]["count"], pairs, unit)
            # Ten steps of 0.5 m, bent a little: at most 2 % of 5 m.
            self.assertLess(f["rpe"]["max"], 0.1 + 1e-9)
            self.assertGreater(f["rpe"]["mean"], 0.08)

    def test_clock_offset_and_interpolation(self):
        reference = self.write("reference.tum", drive())
        late = self.write("late.tum", drive(start_s=107.0))
        f = self.figures(late, reference, "--offset", -7)
        self.assertEqual(f["matched"], 200)
        self.assertLess(f["ape"]["max"], 1e-6)
        between = self.write("between.tum", drive(start_s=100.05))
        message = self.refused(1, between, reference)
        self.assertIn("0.050000 s apart", message)
        f = self.figures(between, reference, "--interpolate")
        self.assertEqual(f["matched"], 199)

    def test_run_folder_and_plot(self):
        self.write("OUT/trajectory.tum", drive(offset=(0.0, 0.0, 2.0)))
        reference = self.write("reference.tum", drive())
        plot = self.folder / "error.svg"
        result = evaluate(self.folder / "OUT", reference, "--plot", plot)
        self.assertEqual(result.returncode, 0, result.stderr)
        for part in ("APE translation m", "RPE over 10 m", "drift", "coverage 100.0 %"):
            self.assertIn(part, result.stdout)
        root = xml.etree.ElementTree.parse(plot).getroot()
        self.assertTrue(root.tag.endswith("svg"))
        self.assertLess(plot.stat().st_size, 100_000)

    def test_kitti_files_of_different_length(self):
        long = self.write("long.txt", kitti(50))
        short = self.write("short.txt", kitti(40))
        f = self.figures(short, long)
        self.assertEqual(f["matched"], 40)
        self.assert_near(f["coverage"], 39 / 49, 1e-9)
        self.assertIn("differ in length (40 and 50 poses)", f["notes"][0])
        self.assertIsNone(f["duration_s"])

    def test_kitti_with_times(self):
        poses = self.write("poses.txt", kitti(20))
        times = self.write("times.txt", [f"{100 + 0.1 * i:.6f}" for i in range(20)])
        reference = self.write("reference.tum", drive(20))
        self.assertIn("--times", self.refused(1, poses, reference))
        self.assertEqual(self.figures(poses, reference, "--times", times)["matched"], 20)
        self.assertIn("--times", self.refused(1, poses, poses, "--rpe-unit", "s"))

    # Bad input: 1 with a message on stderr, 2 for wrong usage

    def test_no_match_names_both_spans(self):
        reference = self.write("reference.tum", drive())
        apart = self.write("apart.tum", drive(start_s=5000.0))
        message = self.refused(1, apart, reference)
        self.assertIn("from 5000.000 s to 5019.900 s", message)
        self.assertIn("from 100.000 s to 119.900 s", message)
        self.assertIn("--offset -4900.000", message)

    def test_bad_files(self):
        good = self.write("good.tum", drive(20))
        self.assertIn("absent.tum", self.refused(1, self.folder / "absent.tum", good))
        rows = drive(20)
        rows[7] = rows[7].replace("0 0", "0 nan", 1)
        self.assertIn("bad.tum:8", self.refused(1, self.write("bad.tum", rows), good))
        empty = self.write("empty.tum", ["# nothing"])
        self.assertIn("empty.tum", self.refused(1, good, empty))
        self.assertIn(str(self.folder), self.refused(1, self.folder, good))
        self.assertIn("sim:", self.refused(1, good, "sim:paper/test1"))
        self.assertIn(
            "no_such_folder", self.refused(1, good, good, "--json", "no_such_folder/x.json")
        )

    def test_wrong_usage(self):
        good = self.write("good.tum", drive(20))
        self.refused(2)
        self.refused(2, good)
        self.refused(2, good, good, "--align", "icp")
        self.refused(2, good, good, "--tolerance", -1)
        self.refused(2, good, good, "--no-such-option")
        self.refused(2, good, good, "--rpe-unit", "f", "--rpe-delta", 1.5)

    def test_map_needs_a_map_and_its_truth(self):
        result = evaluate("map", self.folder, self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("truth/garage.json", result.stderr)
        self.assertEqual(evaluate("map", self.folder).returncode, 2)
        self.assertEqual(evaluate("map", "--min-iou", "2", "a", "b").returncode, 2)

    def test_help_shows_examples(self):
        result = evaluate("--help")
        self.assertEqual(result.returncode, 0)
        for part in ("Examples:", "parkade eval OUT SEQ", "--rpe-delta", "--align", "KITTI"):
            self.assertIn(part, result.stdout)


if __name__ == "__main__":
    unittest.main()
