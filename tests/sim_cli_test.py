#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Drives `parkade sim` as a user does: recordings, interruptions, a full disk, wrong options."""

import filecmp
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

PARKADE = sys.argv.pop(1)
# A small garage, ten frame sets of six pictures.
DRIVE = ["--garage", "random", "--garage-seed", "5003", "--seed", "5003", "--fast", "--labels"]
DRIVE += ["--duration", "1"]


def sim(*arguments):
    return subprocess.run(
        [PARKADE, "sim", *map(str, arguments)], capture_output=True, text=True, timeout=1200
    )


def files_of(folder):
    return sorted(p.relative_to(folder) for p in folder.rglob("*") if p.is_file())


class SimTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="parkade_sim_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out"

    def expect_failure(self, code, *words, arguments):
        result = sim(*arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def test_wrong_options_are_named(self):
        for arguments, code, words in [
            (["--lux", "0"], 1, ["lux", "1", "5000"]),
            (["--lux", "bright"], 1, ["lux", "bright"]),
            (["--route", "test9"], 1, ["test9", "test1"]),
            (["--garage", "castle"], 1, ["castle", "paper"]),
            (["--rig", "nosuch"], 1, ["nosuch"]),
            (["--occupancy", "1.5"], 1, ["occupancy", "1.5"]),
            (["--duration", "-1"], 1, ["duration"]),
            (["--agents", "3"], 2, ["--agents", "comma"]),
            (["--colour", "red"], 2, ["--colour"]),
        ]:
            with self.subTest(arguments=arguments):
                self.expect_failure(code, *words, arguments=[*arguments, "--out", self.out])
                self.assertFalse(self.out.exists(), "what cannot start makes no folder")

    def test_missing_out_is_asked_for(self):
        self.expect_failure(1, "--out", arguments=["--route", "test1"])

    def test_foreign_folder_is_left_alone(self):
        self.out.mkdir()
        (self.out / "letter.txt").write_text("mine", encoding="utf-8")
        self.expect_failure(1, "not empty", arguments=["--no-images", "--out", self.out])
        self.assertEqual(files_of(self.out), [pathlib.Path("letter.txt")])

    def test_other_options_do_not_resume(self):
        quick = ["--no-images", "--duration", "1", "--out", self.out]
        self.assertEqual(sim(*quick).returncode, 0)
        self.expect_failure(1, "other options", arguments=[*quick, "--lux", "50", "--resume"])
        self.expect_failure(1, "--force", "--resume", arguments=quick)

    @unittest.skipUnless(pathlib.Path("/dev/full").exists(), "needs /dev/full")
    def test_full_disk_is_named(self):
        quick = ["--no-images", "--duration", "1", "--out", self.out]
        self.assertEqual(sim(*quick).returncode, 0)
        # Files are written under a temporary name first: this one lands on a full device.
        (self.out / "spec.yaml.tmp").symlink_to("/dev/full")
        self.expect_failure(
            1, "spec.yaml", "No space left on device", arguments=[*quick, "--force"]
        )

    def test_interruptions_and_threads_leave_no_trace(self):
        whole = self.folder / "whole"
        result = sim(*DRIVE, "--threads", "1", "--out", whole)
        self.assertEqual(result.returncode, 0, result.stderr)
        pictures = [p for p in files_of(whole) if p.suffix == ".jpg"]
        self.assertGreaterEqual(len(pictures), 60)

        # Killed as soon as the first picture is there.
        command = [PARKADE, "sim", *DRIVE, "--threads", "2", "--out", str(self.out)]
        with subprocess.Popen(command, stderr=subprocess.DEVNULL) as process:
            while process.poll() is None and not any(self.out.glob("mav0/cam0/data/*.jpg")):
                time.sleep(0.002)
            process.kill()
        self.assertTrue((self.out / "UNFINISHED").exists(), "killed in the middle")
        self.assertLess(len(list(self.out.glob("truth/labels/*/*.png"))), len(pictures))

        # Then the disk is full for the last label image.
        resume = [*DRIVE, "--threads", "2", "--out", self.out, "--resume"]
        if pathlib.Path("/dev/full").exists():
            last = sorted(whole.glob("truth/labels/cam5/*.png"))[-1].relative_to(whole)
            (self.out / last).parent.mkdir(parents=True, exist_ok=True)
            (self.out / f"{last}.tmp").symlink_to("/dev/full")
            self.expect_failure(1, last.name, "No space left on device", arguments=resume)

        result = sim(*resume)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(files_of(whole), files_of(self.out))
        for name in files_of(whole):
            self.assertTrue(filecmp.cmp(whole / name, self.out / name, shallow=False), name)


if __name__ == "__main__":
    unittest.main()
