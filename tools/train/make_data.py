#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Makes training samples with the simulator: stitched pictures and camera views with their labels.

    tools/train/make_data.py --program build/release/parkade --out DATA --garages 0-99
    tools/train/make_data.py --out VIEWS --garages 3000-3249 --frames 5 --views
    tools/train/make_data.py --out TEXTS --garages 2000-2131 --frames 8 --texts --any-letter
    tools/train/make_data.py --out ALL --garages 1600-1899 --frames 10 --everything --any-letter

Every garage has its own layout, style, light, occupancy, people, rig and attitude errors, drawn from
its seed. Goes on where an earlier call ended. Seeds from 5000 on are kept for tests.
"""
import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import time


def settings(seed, frames):
    """How well the stitcher knows the floor (as runs do, mostly) and the own car, and where that stands."""
    rng = random.Random(seed)
    attitude, height = rng.choices([(0.07, 0.3), (0.3, 1.0), (1.0, 1.0)], [0.75, 0.2, 0.05])[0]
    return {
        "frames": frames,
        "masks": "true" if rng.random() < 0.85 else "false",
        "attitude_error_deg": attitude,
        "height_error_cm": height,
        "turn_deg": rng.choice([0.0, 5.0, 15.0]),
        "shift_m": rng.choice([0.0, 0.3, 0.6]),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/parkade", help="the parkade program")
    parser.add_argument("--out", required=True, help="folder of samples")
    parser.add_argument("--garages", default="0-99", help="FIRST-LAST garage seeds")
    parser.add_argument("--frames", type=int, default=16, help="frame sets per garage [16]")
    parser.add_argument("--views", action="store_true",
                        help="all cameras' views and no stitched pictures")
    parser.add_argument("--texts", action="store_true",
                        help="straightened texts to learn reading from instead of pictures")
    parser.add_argument("--everything", action="store_true",
                        help="stitched pictures, all cameras' views and texts")
    parser.add_argument("--any-letter", action="store_true",
                        help="with texts: zones begin at a letter drawn for each garage, not at A")
    arguments = parser.parse_args()
    seeds = re.fullmatch(r"([0-9]+)-([0-9]+)", arguments.garages)
    first, last = (int(text) for text in seeds.groups()) if seeds else (1, 0)
    if first > last:
        parser.error(f"--garages {arguments.garages} is not FIRST-LAST, such as 0-99 or 5-5")
    if last >= 5000:
        parser.error("garage seeds from 5000 on are kept for tests")
    if shutil.which(arguments.program) is None:
        parser.error(f"--program {arguments.program}: no such program")
    failed = 0
    for seed in range(first, last + 1):
        if os.path.exists(os.path.join(arguments.out, f"g{seed:04d}", "done")):
            continue
        command = [arguments.program, "bench", "semantics", "--garages", f"random:{seed}-{seed}",
                   "--samples", arguments.out]
        for name, value in settings(seed, arguments.frames).items():
            command += ["--set", f"{name}={value}"]
        if arguments.views:
            command += ["--set", "stitched=false"]
        if arguments.texts:
            command += ["--texts"]
        if arguments.everything:
            command += ["--everything"]
        if arguments.any_letter:
            # Most garages have few rows of zones, which would leave the later letters unlearnt.
            letter = random.Random(seed + 777).choice("ABCDEFGHJKLMNPQRSTUVWXYZ")
            command += ["--set", f"first_zone={letter}"]
        start = time.time()
        result = subprocess.run(command, capture_output=True, text=True)
        said = "ok"
        if result.returncode != 0:
            failed += 1
            said = f"exit code {result.returncode}: {result.stderr.strip()[-300:]}"
        print(f"garage {seed}: {said}, {time.time() - start:.0f} s", flush=True)
    if failed:
        print(f"{failed} of the garages failed; the same command tries them again", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
