#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Drives `parkade bench` as a user does: a short drive, gates on its accuracy, going on, wrong options."""

import html.parser
import json
import pathlib
import re
import sqlite3
import subprocess
import sys
import tempfile
import unittest

PARKADE = sys.argv.pop(1)
SECONDS = "3"
GATE_M = 0.05
GATE_DEG = 0.5


def bench(*arguments):
    return subprocess.run(
        [PARKADE, "bench", *map(str, arguments)], capture_output=True, text=True, timeout=1400
    )


def map_rows(path):
    """All that a map holds, table by table; of meta no more than its keys."""
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as database:
        tables = database.execute("SELECT name FROM sqlite_master WHERE type='table'").fetchall()
        columns = {"meta": "key"}
        return {
            table: sorted(database.execute(f"SELECT {columns.get(table, '*')} FROM {table}"))
            for (table,) in tables
        }


def slot_scores(run):
    """For people who read the log; a drive this short passes too few slots to gate on."""
    slots = run.get("map", {}).get("slots")
    if slots is None:
        return ""
    figures = [f"{slots['passed']} slots passed"]
    for name in ["recall", "precision"]:
        value = slots.get(name)
        figures.append(f"{name} {'-' if value is None else format(value, '.3f')}")
    corner = slots.get("entrance_error_m", {}).get("median")
    figures.append(f"corner {'-' if corner is None else format(corner, '.3f')} m")
    return ", " + ", ".join(figures)


class BenchErrorTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="parkade_bench_")
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name) / "out"

    def test_wrong_options_are_named(self):
        for arguments, code, words in [
            ([], 2, ["--out"]),
            (["--out", self.out, "--methods", "vis,magic"], 2, ["magic", "fused"]),
            (["--out", self.out, "--routes", "test9"], 2, ["test9", "test1"]),
            (["--out", self.out, "--garages", "castle"], 2, ["castle", "random:N"]),
            (["--out", self.out, "--light", "bright"], 2, ["--light", "bright"]),
            (["--out", self.out, "--occupancy", "60"], 2, ["--occupancy", "between 0 and 1"]),
            (["--out", self.out, "--agents", "3"], 2, ["CARS:PEOPLE", "'3'"]),
            (["--out", self.out, "--calib-error", "0.1:1:2"], 2, ["DEG:CM", "'0.1:1:2'"]),
            (["--out", self.out, "--cameras", "6"], 2, ["1..6"]),
            (["--out", self.out, "--variant", "fused"], 2, ["NAME="]),
            (["--out", self.out, "--variant", "vis=fused"], 2, ["'vis'"]),
            (["--out", self.out, "--light", "0"], 2, ["--light", "5000"]),
            (["--out", self.out, "--variant", "a=magic"], 2, ["magic", "fused"]),
            (["--out", self.out, "--variant", "a=fused,foo=3"], 2, ["a:", "foo"]),
            (["--out", self.out, "--set", "vio.window.keyframes=800"], 2, ["keyframes", "800"]),
            (["--out", self.out, "--import", "a=nowhere"], 2, ["nowhere", "no such folder"]),
            (["--out", self.out, "--sequences", "nowhere"], 2, ["nowhere", "no such folder"]),
            (["--out", self.out, "--sequences", "/usr"], 2, ["/usr", "holds no whole recording"]),
            (["--out", self.out, "--duration", "-1"], 2, ["a number of 0 or more", "'-1'"]),
            (["--out", self.out, "--seeds", "0"], 2, ["--seeds"]),
            (["nonsense", "--out", self.out], 2, ["nonsense"]),
        ]:
            with self.subTest(arguments=arguments):
                result = bench(*arguments)
                self.assertEqual(result.returncode, code, result.stderr)
                for word in words:
                    self.assertIn(word, result.stderr)
                self.assertFalse(self.out.exists())

    def test_semantics_stays_a_command_of_its_own(self):
        result = bench("semantics", "--help")
        self.assertEqual(result.returncode, 0)
        self.assertIn("--samples", result.stdout)

    def test_texts_to_learn_reading_from(self):
        result = bench("semantics", "--out", self.out, "--texts")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--texts needs --samples", result.stderr)
        result = bench("semantics", "--garages", "random:2140-2140", "--samples", self.out, "--texts",
                       "--fast", "--set", "frames=2", "--set", "coarse_light=true")
        self.assertEqual(result.returncode, 0, result.stderr)
        kinds = set()
        for path in self.out.glob("g2140/*_texts.csv"):
            lines = path.read_text().splitlines()
            self.assertEqual(lines[0], "text,height_px,slant_deg,distance_m,kind")
            strip = path.with_suffix(".png").read_bytes()
            height = int.from_bytes(strip[20:24], "big")
            self.assertEqual(height, 40 * (len(lines) - 1))
            kinds |= {line.split(",")[4] for line in lines[1:]}
        self.assertLessEqual({"true", "shaken", "network"}, kinds)

    def test_all_samples_of_one_drive(self):
        for more in ([], ["--texts", "--samples", self.out], ["--set", "stitched=false", "--samples", self.out]):
            result = bench("semantics", "--everything", *(more or ["--out", self.out]))
            self.assertEqual(result.returncode, 2)
            self.assertIn("--everything goes with --samples", result.stderr)
        result = bench("semantics", "--garages", "random:2140-2140", "--samples", self.out, "--everything",
                       "--fast", "--set", "frames=1", "--set", "coarse_light=true")
        self.assertEqual(result.returncode, 0, result.stderr)
        names = {path.name for path in (self.out / "g2140").iterdir()}
        views = {f"000_raw{k}{end}" for k in range(4) for end in (".jpg", "_labels.png")}
        self.assertLessEqual({"000_bev.png", "000_bev_labels.png", "done"} | views, names)
        self.assertTrue(any(name.endswith("_texts.csv") for name in names), names)

    def test_slot_trials(self):
        result = bench("semantics", "--samples", self.out, "--slot-trials")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--slot-trials goes with --out", result.stderr)
        result = bench("semantics", "--garages", "random:440-440", "--out", self.out, "--slot-trials",
                       "--labels", "truth", "--fast", "--set", "frames=3", "--set", "coarse_light=true")
        self.assertEqual(result.returncode, 0, result.stderr)
        header, *rows = (self.out / "slot_trials.csv").read_text().splitlines()
        self.assertTrue(header.startswith("garage,right,doubt,seen,"))
        self.assertTrue(any(row.startswith("440,1,") for row in rows))
        self.assertEqual({len(row.split(",")) for row in rows}, {len(header.split(","))})


class PageParser(html.parser.HTMLParser):
    """Gathers what a page would load, and tags left open."""

    VOID = {"meta", "link", "img"}

    def __init__(self):
        super().__init__()
        self.addresses = []
        self.open = []

    def handle_starttag(self, tag, attributes):
        if tag not in self.VOID:
            self.open.append(tag)
        for name, value in attributes:
            if name in ("src", "href"):
                self.addresses.append(value)

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-3:]}"
        self.open.pop()


class BenchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="parkade_bench_")
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.out = pathlib.Path(cls.temporary.name) / "out"
        cls.imports = pathlib.Path(cls.temporary.name) / "outside"
        cls.imports.mkdir()
        cls.arguments = ["--out", cls.out, "--routes", "test1", "--duration", SECONDS, "--fast"]
        cls.arguments += ["--methods", "vis,fused", "--threads", "2"]
        cls.arguments += ["--import", f"outside={cls.imports}"]
        cls.result = bench(*cls.arguments)
        cls.metrics = json.loads((cls.out / "metrics.json").read_text(encoding="utf-8"))
        cls.runs = {run["method"]: run for run in cls.metrics["runs"]}

    def check_page(self, path):
        text = path.read_text(encoding="utf-8")
        parser = PageParser()
        parser.feed(text)
        self.assertEqual(parser.open, [])
        self.assertGreater(len(parser.addresses), 4)
        for address in parser.addresses:
            self.assertTrue(address.startswith("data:"), address[:60])
        return text

    def test_a_failed_run_is_a_row_that_says_so(self):
        self.assertEqual(self.result.returncode, 1, self.result.stderr)
        self.assertIn("1 of 3 runs failed", self.result.stderr)
        self.assertEqual(self.runs["outside"]["status"], "failed")
        self.assertIn("no such file", self.runs["outside"]["reason"])
        self.assertIn("failed", (self.out / "tables.md").read_text(encoding="utf-8"))

    def test_accuracy_gates(self):
        for method in ["vis", "fused"]:
            run = self.runs[method]
            self.assertEqual(run["status"], "done", run.get("reason"))
            print(
                f"{method}: {run['ape']['rmse']:.4f} m over {run['path_m']:.1f} m, real-time "
                f"factor {run['timing']['real_time_factor']:.2f}{slot_scores(run)}",
                flush=True,
            )
            # The start of a route: errors are a few millimetres to centimetres there.
            self.assertLess(run["ape"]["rmse"], GATE_M)
            self.assertLess(run["ape_heading_deg"]["rmse"], GATE_DEG)
            self.assertGreater(run["coverage"], 0.5)
            self.assertGreater(run["timing"]["peak_memory_mb"], 10)

    def test_tables_hold_the_paper_beside_ours(self):
        for text in [self.result.stdout, (self.out / "tables.md").read_text(encoding="utf-8")]:
            self.assertRegex(text, r"Paper: Ours\W+0\.14\W+0\.19\W+0\.21\W+0\.28\W+0\.15\W+0\.19")
            self.assertRegex(text, r"Parkade: fused, all cameras\W+0\.\d\d\d")
            self.assertIn("Table 3", text)

    def test_pages_need_nothing_else(self):
        pictures = ["Tracks of key points", "stitched on the ground", "what is found on it"]
        pictures += [f"Layer {number}: " for number in range(1, 6)]
        pictures += ["The local map", "The global map", "Where the time"]
        bench_page = self.check_page(self.out / "report.html")
        self.assertIn("Table 2", bench_page)
        runs = self.out / "runs" / "test1"
        run_page = self.check_page(runs / "fused" / "report.html")
        for text in [bench_page, run_page]:
            for caption in pictures:
                self.assertIn(caption, text)
            self.assertLess(len(text), 5_000_000)
        # What a method does not give is said, not left blank.
        text = self.check_page(runs / "vis" / "report.html")
        self.assertIn("Layers: none, as the method vis makes no map", text)
        self.assertIn("Features: none, as the method vis uses no semantics", text)

    def test_the_same_drive_again_gives_the_same_bytes(self):
        first = self.out / "runs" / "test1" / "fused"
        again = self.imports.parent / "again"
        result = subprocess.run(
            [PARKADE, "run", self.out / "sequences" / "test1", "--method", "fused", "--threads", "1",
             "--out", again],
            capture_output=True, text=True, timeout=1400,
        )  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stderr)
        # The cameras' own pictures were looked at, so what they say is in the map.
        stages = json.loads((again / "timing.json").read_text(encoding="utf-8"))["stages"]
        self.assertGreater(stages["zone markers"]["count"], 5)
        for name in ["trajectory.tum", "trajectory_vio.tum", "covariance.csv", "health.csv"]:
            self.assertEqual((first / name).read_bytes(), (again / name).read_bytes(), name)
        rows = map_rows(again / "map.db")
        self.assertGreater(len(rows["object"]), 0)
        self.assertEqual(map_rows(first / "map.db"), rows)

    def test_another_calibration_is_told_over_the_same_pictures(self):
        other = self.imports.parent / "calibration"
        result = bench(
            "--out", other, "--routes", "test1", "--duration", SECONDS, "--fast", "--methods", "vis",
            "--sequences", self.out / "sequences", "--calib-error", "0.5:1",
        )  # fmt: skip
        self.assertEqual(result.returncode, 0, result.stderr)
        folder = other / "sequences" / "test1_calib0.5-1"
        self.assertTrue((folder / "mav0" / "cam0" / "data").is_symlink())
        drawn = self.out / "sequences" / "test1"
        self.assertNotEqual((folder / "rig.yaml").read_text(), (drawn / "rig.yaml").read_text())
        metrics = json.loads((other / "metrics.json").read_text(encoding="utf-8"))
        errors = {run["condition"]: run["ape"]["rmse"] for run in metrics["runs"]}
        self.assertEqual(set(errors), {"", "calibration off by 0.5 deg, 1 cm"})
        self.assertNotEqual(*errors.values())

    def test_goes_on_where_it_stopped(self):
        pictures = list((self.out / "sequences").rglob("*.jpg"))
        stamps = {path: path.stat().st_mtime_ns for path in pictures}
        (self.out / "runs" / "test1" / "vis" / "bench.json").unlink()
        again = bench(*self.arguments)
        self.assertEqual(len(re.findall(r"\(kept\)", again.stderr)), 1, again.stderr)
        self.assertRegex(again.stderr, r"test1 fused: .*\(kept\)")
        metrics = json.loads((self.out / "metrics.json").read_text(encoding="utf-8"))
        rows = {run["method"]: run for run in metrics["runs"]}
        self.assertEqual(rows["vis"]["ape"], self.runs["vis"]["ape"])
        for path, stamp in stamps.items():
            self.assertEqual(path.stat().st_mtime_ns, stamp)


if __name__ == "__main__":
    unittest.main()
