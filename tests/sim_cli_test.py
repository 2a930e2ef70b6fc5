#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Drives `parkade sim` as a user does: recordings, interruptions, a full disk, wrong options."""

import filecmp
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PARKADE = sys.argv.pop(1)
# A small garage, ten frame sets of six pictures.
DRIVE = ["--garage", "random", "--garage-seed", "5003", "--seed", "5003", "--fast", "--labels"]
DRIVE += ["--duration", "1"]

# Two cameras of 160 x 100 pixels: what is tested is the writing.
SMALL_RIG = """
name: small
vehicle: {wheelbase: 2.85, track: 1.6, front_overhang: 0.9, rear_overhang: 1, width: 1.86, height: 1.48}
cameras:
  - name: cam0
    camera_model: pinhole
    intrinsics: [72.5, 72.5, 79.5, 49.5]
    distortion_model: equidistant
    distortion_coeffs: [0.01, -0.004, 0.0006, -0.0001]
    resolution: [160, 100]
    T_vehicle_cam: [[0, -0.258819045103, 0.965925826289, 3.77], [-1, 0, 0, 0],
                    [0, -0.965925826289, -0.258819045103, 0.65], [0, 0, 0, 1]]
    rate: 10
  - name: cam1
    camera_model: pinhole
    intrinsics: [72.5, 72.5, 79.5, 49.5]
    distortion_model: equidistant
    distortion_coeffs: [0.01, -0.004, 0.0006, -0.0001]
    resolution: [160, 100]
    T_vehicle_cam: [[0, 0.374606593416, -0.927183854567, -1.02], [1, 0, 0, 0],
                    [0, -0.927183854567, -0.374606593416, 0.9], [0, 0, 0, 1]]
    rate: 10
imu:
  T_vehicle_imu: [[1, 0, 0, 1.2], [0, 1, 0, 0], [0, 0, 1, 0.4], [0, 0, 0, 1]]
  gyroscope_noise_density: 2.44e-4
  gyroscope_random_walk: 2.0e-5
  accelerometer_noise_density: 1.86e-3
  accelerometer_random_walk: 2.0e-4
  rate: 200
"""
# Runs a program on a small disk of its own, and again with room: DISK SIZE COPIES COMMAND...
ON_A_SMALL_DISK = """
disk=$1; size=$2; copies=$3; shift 3
mount -t tmpfs -o "size=$size" tmpfs "$disk" || exit 99
"$@"; first=$?
cp -a "$disk/." "$copies/full"
mount -o remount,size=256m "$disk" || exit 98
"$@" --resume; second=$?
cp -a "$disk/." "$copies/roomy"
echo "$first $second"
"""
NO_SPACE = "No space left on device|is the disk full|has space"


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
            (["--lux", "0"], 2, ["lux", "1", "5000"]),
            (["--lux", "bright"], 2, ["lux", "bright"]),
            (["--route", "test9"], 2, ["test9", "test1"]),
            (["--garage", "castle"], 2, ["castle", "paper"]),
            (["--rig", "nosuch"], 2, ["nosuch"]),
            (["--occupancy", "1.5"], 2, ["occupancy", "1.5"]),
            (["--duration", "-1"], 2, ["duration"]),
            (["--one-way", "0.5"], 2, ["one_way", "paper"]),
            (["--garage", "random", "--one-way", "2"], 2, ["one_way", "2"]),
            (["--garage", "random", "--first-zone", "I"], 2, ["first_zone", "'I'"]),
            (["--agents", "3"], 2, ["--agents", "comma"]),
            (["--colour", "red"], 2, ["--colour"]),
        ]:
            with self.subTest(arguments=arguments):
                self.expect_failure(code, *words, arguments=[*arguments, "--out", self.out])
                self.assertFalse(self.out.exists(), "what cannot start makes no folder")

    def test_missing_out_is_asked_for(self):
        self.expect_failure(2, "--out", arguments=["--route", "test1"])

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

    def test_one_way_aisles_are_in_the_truth(self):
        quick = ["--garage", "random", "--garage-seed", "5003", "--no-images", "--duration", "1"]
        edges = {}
        for share in [None, "0", "1"]:
            out = self.folder / f"share_{share}"
            option = [] if share is None else ["--one-way", share]
            result = sim(*quick, *option, "--out", out)
            self.assertEqual(result.returncode, 0, result.stderr)
            garage = json.loads((out / "truth/garage.json").read_text(encoding="utf-8"))
            edges[share] = [edge["one_way"] for edge in garage["aisles"]["edges"]]
            # Recordings from before the option go on: their spec.yaml does not know it.
            told = "one_way" in (out / "spec.yaml").read_text(encoding="utf-8")
            self.assertEqual(told, share == "1")
        self.assertFalse(any(edges[None]) or any(edges["0"]))
        self.assertTrue(any(edges["1"]))

    def test_rolling_shutters_are_told(self):
        quick = ["--no-images", "--duration", "1"]
        for readout in ["0", "30"]:
            out = self.folder / f"readout_{readout}"
            result = sim(*quick, "--readout-ms", readout, "--out", out)
            self.assertEqual(result.returncode, 0, result.stderr)
            rolling = readout == "30"
            rig = (out / "rig.yaml").read_text(encoding="utf-8")
            self.assertEqual(rig.count("readout_time: 0.03\n"), 6 if rolling else 0)
            # Recordings from before the option go on: their spec.yaml does not know it.
            spec = (out / "spec.yaml").read_text(encoding="utf-8")
            self.assertEqual("readout_ms" in spec, rolling)

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


class WritingTest(unittest.TestCase):
    """A small recording with every kind of file, ended in many ways."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix="parkade_sim_")
        cls.base = pathlib.Path(cls.scratch.name)
        rig = cls.base / "small.yaml"
        rig.write_text(SMALL_RIG, encoding="utf-8")
        cls.drive = ["--garage", "random", "--garage-seed", "5011", "--seed", "5011", "--fast"]
        cls.drive += ["--duration", "1", "--rig", str(rig), "--threads", "1"]
        cls.pictures = ["--labels", "--bev-labels", "--gray-png"]

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def setUp(self):
        self.folder = self.base / self.id().rsplit(".", maxsplit=1)[-1]
        self.folder.mkdir()
        self.out = self.folder / "out"

    def record_whole(self, *options):
        """What nothing disturbs, to compare with."""
        self.whole = self.folder / "whole"
        self.command = ["sim", *self.drive, *options]
        result = sim(*self.command[1:], "--out", self.whole)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.names = files_of(self.whole)

    def expect_same(self, name, folder):
        self.assertTrue(filecmp.cmp(self.whole / name, folder / name, shallow=False), name)

    def expect_whole_files(self, folder):
        """What has its name is whole; the rest, and the folder, are called unfinished."""
        names = files_of(folder)
        if names != [pathlib.Path("spec.yaml")] and names != []:
            self.assertIn(pathlib.Path("UNFINISHED"), names)
        for name in names:
            if name.suffix not in (".tmp", ".part") and name.name != "UNFINISHED":
                self.assertIn(name, self.names)
                self.expect_same(name, folder)

    def expect_finished(self, folder):
        self.assertEqual(files_of(folder), self.names)
        for name in self.names:
            self.expect_same(name, folder)

    def interrupt(self, how, there, hold=None):
        """Ends the program by a signal once a file is there. It is held where it wants to write the
        file named by hold: opening a pipe that nobody reads waits."""
        pipe = None
        if hold is not None:
            pipe = self.out / f"{hold}.tmp"
            os.mkfifo(pipe)
        command = [PARKADE, *self.command, "--out", str(self.out)]
        command += ["--resume"] if self.out.exists() else []
        # A shell's background jobs ignore interruptions by the keyboard.
        with subprocess.Popen(
            command,
            stderr=subprocess.DEVNULL,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        ) as process:
            while process.poll() is None and not (self.out / there).exists():
                time.sleep(0.002)
            process.send_signal(how)
        self.assertEqual(process.returncode, -how, "ended by the signal, not before")
        if pipe is not None:
            self.assertFalse((self.out / hold).exists(), hold)
            pipe.unlink()
        self.expect_whole_files(self.out)

    def test_what_has_its_name_is_whole_whenever_it_was_interrupted(self):
        self.record_whole(*self.pictures)
        stamps = sorted(p.stem for p in (self.whole / "truth/labels/cam0").iterdir())
        self.assertEqual(len(stamps), 10)
        label = "truth/labels/{}/{}.png".format
        ground = "truth/bev_labels/{}.png".format
        self.interrupt(signal.SIGINT, f"mav0/cam0/data/{stamps[0]}.png")
        self.interrupt(signal.SIGKILL, label("cam0", stamps[3]), label("cam1", stamps[3]))
        # What a program leaves that dies while it writes.
        for name in [
            label("cam1", stamps[3]),
            ground(stamps[5]),
            f"mav0/cam1/data/{stamps[7]}.png",
            "truth/agents.csv",
            "truth/rig.yaml",
            "rig.yaml",
        ]:
            half = (self.whole / name).read_bytes()
            (self.out / f"{name}.tmp").write_bytes(half[: len(half) // 2])
        self.interrupt(signal.SIGTERM, label("cam1", stamps[6]), ground(stamps[6]))
        result = sim(*self.command[1:], "--out", self.out, "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.expect_finished(self.out)

    def on_a_small_disk(self, size):
        """Records on a disk that is too small, looks at it, resumes on a larger one. What was said
        of the first."""
        unshare = ["unshare", "--map-root-user", "--mount", "sh", "-c", ON_A_SMALL_DISK, "sh"]
        disk = self.folder / "disk"
        copies = self.folder / f"copies_{size}"
        for folder in (disk, copies / "full", copies / "roomy"):
            folder.mkdir(parents=True, exist_ok=True)
        command = [PARKADE, *self.command, "--out", disk / "out"]
        try:
            result = subprocess.run(
                [*unshare, disk, str(size), copies, *command],
                capture_output=True,
                text=True,
                timeout=1200,
            )
        except FileNotFoundError:
            self.skipTest("needs the program unshare, to mount a small disk")
        if result.returncode != 0:
            self.skipTest(f"no small disk can be mounted here: {result.stderr.strip()}")
        self.assertEqual(result.stdout, "1 0\n", result.stderr)
        self.assertRegex(result.stderr, f"{disk}.*({NO_SPACE})")
        self.expect_whole_files(copies / "full/out")
        self.expect_finished(copies / "roomy/out")
        shutil.rmtree(copies)
        return next(line for line in result.stderr.splitlines() if re.search(NO_SPACE, line))

    def test_full_disk_at_any_file_leaves_whole_files(self):
        self.record_whole("--no-images")
        page = os.sysconf("SC_PAGE_SIZE")
        said = ""
        for pages in range(1, 60):
            with self.subTest(pages=pages):
                text = self.on_a_small_disk(pages * page)
                said += text + "\n"
                if "garage.json" in text:  # by far the largest
                    break
        for name in ["UNFINISHED", "trajectory.tum", "data.csv", "truth/rig.yaml", "garage.json"]:
            self.assertIn(name, said)

    def test_full_disk_amid_pictures_leaves_whole_files(self):
        self.record_whole(*self.pictures)
        page = os.sysconf("SC_PAGE_SIZE")
        needed = sum(-(-(self.whole / n).stat().st_size // page) * page for n in self.names)
        pictures = sum(
            (self.whole / n).stat().st_size for n in self.names if n.as_posix().startswith("mav0/cam")
        )
        self.assertRegex(self.on_a_small_disk(needed - pictures // 2), r"\.png|is the disk full")


if __name__ == "__main__":
    unittest.main()
