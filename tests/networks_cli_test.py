#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Brings an own network to `parkade bev --overlay` and `parkade bench semantics`, good ones and bad."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PARKADE = sys.argv.pop(1)
SOURCE = pathlib.Path(__file__).resolve().parent.parent
NETWORKS = SOURCE / "tests" / "data" / "networks"
PICTURES = SOURCE / "docs" / "images" / "simulator"


def parkade(*arguments):
    return subprocess.run(
        [PARKADE, *map(str, arguments)], capture_output=True, text=True, timeout=1200
    )


class NetworksTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="parkade_networks_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def bev(self, out, *more):
        images = [f"--image=cam{k}={PICTURES / f'cam{k}.jpg'}" for k in range(6)]
        rig = SOURCE / "config" / "rigs" / "avp6.yaml"
        return parkade("bev", "--rig", rig, *images, "--out", self.folder / out, *more)

    def test_overlay_of_an_own_network(self):
        plain = self.bev("plain")
        self.assertEqual(plain.returncode, 0, plain.stderr)
        overlay = self.bev("overlay", "--overlay", "--network", NETWORKS / "bright.yaml")
        self.assertEqual(overlay.returncode, 0, overlay.stderr)
        (before,) = (self.folder / "plain").glob("*.png")
        (after,) = (self.folder / "overlay").glob("*.png")
        self.assertNotEqual(before.read_bytes(), after.read_bytes())

    def test_bad_networks_end_with_a_message(self):
        missing = self.bev("a", "--overlay", "--network", self.folder / "none.yaml")
        self.assertEqual(missing.returncode, 1)
        self.assertIn("none.yaml", missing.stderr)
        wrong = self.folder / "wrong.yaml"
        text = (NETWORKS / "bright.yaml").read_text(encoding="utf-8")
        text = text.replace("bright.onnx", str(NETWORKS / "bright.onnx"))
        wrong.write_text(text.replace("pillar, floor,", "floor,"), encoding="utf-8")
        result = self.bev("b", "--overlay", "--network", wrong)
        self.assertEqual(result.returncode, 1)
        self.assertIn("2 classes", result.stderr)
        # One size only, and the stitched picture has another.
        wrong.write_text(text.replace("any_size: true", "any_size: false"), encoding="utf-8")
        result = self.bev("c", "--overlay", "--network", wrong)
        self.assertEqual(result.returncode, 1)
        self.assertIn("48 x 32 px", result.stderr)

    def test_makes_no_folder_in_vain_and_writes_over_nothing(self):
        for arguments in [
            ["--overlay", "--network", self.folder / "none.yaml"],
            ["--network", NETWORKS / "bright.yaml"],  # without --overlay
            ["--image", "cam9=nothing.png"],
            ["--set", "width_px=many"],
        ]:
            result = self.bev("vain", *arguments)
            self.assertNotEqual(result.returncode, 0)
            self.assertFalse((self.folder / "vain").exists(), arguments)
        result = parkade("bev", self.folder / "nowhere", "--out", self.folder / "vain")
        self.assertEqual(result.returncode, 1)
        self.assertFalse((self.folder / "vain").exists())
        foreign = self.folder / "foreign"
        foreign.mkdir()
        (foreign / "thesis.tex").write_text("years of work", encoding="utf-8")
        result = self.bev("foreign")
        self.assertEqual(result.returncode, 1)
        self.assertIn("--force", result.stderr)
        self.assertEqual([p.name for p in foreign.iterdir()], ["thesis.tex"])
        self.assertEqual(self.bev("foreign", "--force").returncode, 0)
        self.assertEqual(len(list(foreign.iterdir())), 2)

    def test_bench_scores_and_writes_metrics(self):
        out = self.folder / "bench"
        result = parkade(
            "bench", "semantics", "--garages", "random:4999-4999", "--out", out, "--fast",
            "--network", NETWORKS / "bright.yaml", "--set", "frames=1", "--set", "coarse_light=on",
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("mean of the ground", result.stdout)
        metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
        self.assertEqual(metrics["garages"], [4999])
        scores = metrics["segmentation"]["bev"]
        self.assertGreater(scores["iou"]["floor"], 0.1)
        self.assertLessEqual(scores["iou"]["floor"], 1.0)

    def test_marking_points_of_real_pictures(self):
        data = pathlib.Path(os.environ.get("PARKADE_TEST_DATA", SOURCE.parent / "shared" / "data"))
        if not (data / "ps20_bev" / "annotations.txt").exists():
            self.skipTest(f"no {data}/ps20_bev")
        out = self.folder / "points"
        result = parkade("bench", "semantics", "--marking-points", data / "ps20_bev", "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        metrics = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
        scores = metrics["marking_points"]
        self.assertEqual(scores["pictures"], 20)
        self.assertEqual(scores["corners of slots"]["true"], 49)
        # The network never saw a real picture.
        self.assertGreater(scores["where lines meet"]["recall"], 0.4)
        self.assertGreater(scores["where lines meet"]["precision"], 0.7)
        self.assertGreater(scores["corners and ends of lines"]["recall"], 0.5)

    def test_broken_annotations(self):
        folder = self.folder / "marked"
        folder.mkdir()
        arguments = ("bench", "semantics", "--marking-points", folder, "--out", self.folder / "y")
        result = parkade(*arguments)
        self.assertEqual(result.returncode, 1)
        self.assertIn("annotations.txt", result.stderr)
        lines = "a.jpg 1,2,3,4,0\nb.jpg 1,2,3\n"
        (folder / "annotations.txt").write_text(lines, encoding="utf-8")
        result = parkade(*arguments)
        self.assertEqual(result.returncode, 1)
        self.assertIn("annotations.txt:2", result.stderr)
        self.assertIn("x0,y0,x1,y1,class", result.stderr)

    def test_wrong_garages(self):
        for text in ("random", "paper", "random:0", "random:9-3", "random:x"):
            result = parkade("bench", "semantics", "--garages", text, "--out", self.folder / "x")
            self.assertEqual(result.returncode, 2, text)
            self.assertIn("random:FIRST-LAST", result.stderr)


if __name__ == "__main__":
    os.environ.pop("PARKADE_MODELS", None)
    unittest.main()
