#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Compares `parkade bev` with a stitched picture that others made, and with the simulator's ground.

    bev_reference_test.py PARKADE
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import yaml
from PIL import Image

PARKADE = sys.argv.pop(1)
SOURCE = pathlib.Path(__file__).resolve().parent.parent
DATA = pathlib.Path(os.environ.get("PARKADE_TEST_DATA", SOURCE.parent / "shared" / "data"))


def parkade(*arguments):
    result = subprocess.run(
        [PARKADE, *map(str, arguments)], capture_output=True, text=True, timeout=1200
    )
    if result.returncode != 0:
        raise AssertionError(f"{arguments}: {result.stdout}{result.stderr}")


def grey(path):
    return np.asarray(Image.open(path).convert("RGB"), float).mean(2)


def correlation(a, b):
    a, b = a - a.mean(), b - b.mean()
    return float((a * b).sum() / max(1e-9, np.sqrt((a * a).sum() * (b * b).sum())))


def blurred(image):
    """Three pixels wide, binomial."""
    for axis in (0, 1):
        image = 0.5 * image + 0.25 * (np.roll(image, 1, axis) + np.roll(image, -1, axis))
    return image


def corners_of(mask, reach):
    """Places where painted edges of two directions meet, each the best within `reach` px."""
    gy, gx = np.gradient(blurred(blurred(mask)))
    tensor = [gx * gx, gy * gy, gx * gy]
    for _ in range(4):
        tensor = [blurred(t) for t in tensor]
    xx, yy, xy = tensor
    least = 0.5 * (xx + yy) - np.sqrt(0.25 * (xx - yy) ** 2 + xy**2)
    found = []
    while least.max() > 0.006:
        y, x = np.unravel_index(least.argmax(), least.shape)
        found.append((y, x))
        least[max(0, y - reach) : y + reach, max(0, x - reach) : x + reach] = 0.0
    return found


def offset_of(picture, mask, place, down, half=10, search=3):
    """How far the picture's paint lies from the mask's, px, and how well they agree. The picture's
    rows are those of the mask plus `down`."""
    y, x = place
    template = blurred(mask)[y - half : y + half + 1, x - half : x + half + 1]
    y += round(down)
    score = np.zeros((2 * search + 1, 2 * search + 1))
    for dy in range(-search, search + 1):
        for dx in range(-search, search + 1):
            part = picture[y + dy - half : y + dy + half + 1, x + dx - half : x + dx + half + 1]
            score[dy + search, dx + search] = correlation(part, template)
    best = np.unravel_index(score.argmax(), score.shape)
    shift = []
    for axis in (0, 1):
        if not 0 < best[axis] < 2 * search:
            return None, 0.0
        step = np.eye(2, dtype=int)[axis]
        below, above = score[tuple(best - step)], score[tuple(best + step)]
        top = score[best]
        shift.append(best[axis] - search + 0.5 * (above - below) / (2 * top - above - below))
    shift[0] -= down - round(down)
    return float(np.hypot(*shift)), float(score[best])


class BevReferenceTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="parkade_bev_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_stitched_picture_of_others(self):
        data = DATA / "garage_fisheye_sim"
        if not data.is_dir():
            self.skipTest(f"{data} is absent")
        reference = grey(data / "ipm_img.png")
        pictures = []
        for camera in range(4):
            out = self.folder / str(camera)
            parkade("bev", "--rig", SOURCE / "config/rigs/garage_fisheye_sim.yaml",
                    "--image", f"cam{camera}={data / f'{camera}.png'}", "--out", out,
                    "--set", "width_px=1000", "--set", "height_px=1000",
                    "--set", "metres_per_px=0.02", "--set", "max_range_m=20",
                    "--set", "balance_gains=false")
            pictures.append(grey(next(out.glob("*.png"))))
        pictures = np.array(pictures)
        count = (pictures > 0).sum(0)
        # Its authors add 8-bit pictures and halve the sum, which stops at 255 before.
        emulated = np.minimum(pictures.sum(0), 255.0) / np.maximum(count, 1)
        common = (count > 0) & (reference > 0)
        whole = correlation(emulated[common], reference[common])
        print(f"correlation with the reference, blended as its authors do: {whole:.3f}")
        self.assertGreater(common.mean(), 0.9)
        self.assertGreater(whole, 0.97)
        for camera in range(4):
            alone = common & (pictures[camera] > 0) & (count == 1)
            value = correlation(pictures[camera][alone], reference[alone])
            print(f"cam{camera} alone, {100 * alone.mean():.1f} % of the picture: {value:.3f}")
            self.assertGreater(value, 0.9)

    def test_paint_lies_where_the_ground_has_it(self):
        sequence = self.folder / "sequence"
        parkade("sim", "--garage", "random", "--garage-seed", "5003", "--lux", "300",
                "--agents", "0,0", "--noise", "off", "--load", "off", "--duration", "1",
                "--fast", "--bev-labels", "--out", sequence)
        size, metres_per_px = 480, 0.03  # as the labels
        parkade("bev", sequence, "--duration", "0.15", "--out", self.folder / "bev",
                "--set", f"width_px={size}", "--set", f"height_px={size}",
                "--set", f"metres_per_px={metres_per_px}")
        labels = sorted((sequence / "truth" / "bev_labels").glob("*.png"))
        pictures = sorted((self.folder / "bev").glob("*.png"))
        self.assertTrue(labels and pictures, (labels, pictures))
        truth = np.asarray(Image.open(labels[0]))
        picture = grey(pictures[0])
        self.assertEqual(truth.shape, picture.shape)
        # Labels lie about the rear axle, pictures about the car's middle.
        rig = yaml.safe_load((sequence / "rig.yaml").read_text())
        car = rig["vehicle"]
        middle = 0.5 * (car["wheelbase"] + car["front_overhang"] - car["rear_overhang"])
        down = middle / metres_per_px
        paint = np.isin(truth, [2, 3, 4, 5, 6]).astype(float)
        offsets = []
        for place in corners_of(paint, 12):
            y, x = place[0] + down, place[1]
            metres = metres_per_px * np.hypot(y - 0.5 * size, x - 0.5 * size)
            if metres > 5.0 or min(*place, y, x) < 16 or max(*place, y, x) > size - 17:
                continue
            window = picture[round(y) - 13 : round(y) + 14, x - 13 : x + 14]
            offset, agreement = offset_of(picture, paint, place, down)
            if offset is None or agreement < 0.8 or window.min() == 0:
                continue
            offsets.append(offset)
        print(f"{len(offsets)} corners within 5 m: median {np.median(offsets):.2f} px, "
              f"most {max(offsets):.2f} px")
        self.assertGreaterEqual(len(offsets), 8)
        self.assertLess(max(offsets), 1.0)


if __name__ == "__main__":
    unittest.main()
