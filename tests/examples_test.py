#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the example programs: examples_test.py FEED FOLLOW USE"""
import os
import subprocess
import sys
import tempfile

from command import run

SEQUENCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "shared", "data",
                        "euroc_mh01_16s")


def main():
    feed, follow, use = sys.argv[1:4]
    sequence = os.environ.get("PARKADE_TEST_DATA", os.path.dirname(SEQUENCE)) + "/euroc_mh01_16s"
    if os.path.isdir(sequence):
        words = run(feed, sequence, "8").split()
        poses = int(words[0])
        assert 60 <= poses <= 81, poses  # the pictures begin after 4 s, at 20 Hz
    else:
        print(f"left out 01_feed_a_source: no recording in {sequence}")
    with tempfile.TemporaryDirectory() as folder:
        database = os.path.join(folder, "map.db")
        text = run(follow, database, "6")
        lines = [line for line in text.splitlines() if line.startswith("x ")]
        assert len(lines) >= 5, text
        assert "tracking" in lines[-1], text
        assert os.path.getsize(database) > 0
        text = run(use, database, "2", "0")
        assert "slots are free" in text, text
        assert "the grid at 2.00 0.00 m" in text, text
        missing = subprocess.run([use, os.path.join(folder, "none.db")], capture_output=True,
                                 text=True)
        assert missing.returncode == 1 and "none.db" in missing.stderr, missing.stderr


if __name__ == "__main__":
    main()
