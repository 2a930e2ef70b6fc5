# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Texts to learn reading from: rendered faces, and what make_data.py --texts wrote: faces of zone
markers and numbers in slots."""
import csv
import glob
import os

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

from text_network import HEIGHT, WIDTH, ZONE_LETTERS

LETTERS = ZONE_LETTERS[10:-1]
FONTS = ["DejaVuSans-Bold", "DejaVuSansCondensed-Bold", "DejaVuSans", "DejaVuSansMono-Bold",
         "LiberationSans-Bold", "LiberationSansNarrow-Bold", "LiberationSans-Regular",
         "LiberationMono-Bold", "DejaVuSerif-Bold"]


def fonts():
    """The fonts of FONTS that are installed (Debian: fonts-dejavu, fonts-liberation)."""
    paths = {os.path.splitext(os.path.basename(path))[0]: path
             for path in glob.glob("/usr/share/fonts/truetype/*/*.ttf")}
    found = [ImageFont.truetype(paths[name], 60) for name in FONTS if name in paths]
    if not found:
        raise SystemExit("no fonts found; install fonts-dejavu and fonts-liberation")
    return found


def random_text(rng):
    """Mostly a letter with a number, as zones are named; also anything else."""
    letter = LETTERS[rng.integers(len(LETTERS))]
    number = str(rng.integers(1, 100) if rng.random() < 0.5 else rng.integers(1, 20))
    kind = rng.random()
    if kind < 0.3:
        return letter + number
    if kind < 0.45:
        return f"{letter}-{number}"
    if kind < 0.6:
        return letter + number.zfill(2)
    if kind < 0.75:
        return number + letter
    if kind < 0.8:
        return letter + LETTERS[rng.integers(len(LETTERS))] + number
    return "".join(ZONE_LETTERS[rng.integers(len(ZONE_LETTERS) - 1)] for _ in range(rng.integers(1, 5)))


def plate(rng, text, font, size, back, ink):
    """One face of size (width, height), four times as fine as the patch; the middle of each letter
    along it."""
    width, height = size
    face = Image.new("RGB", size, tuple(back))
    middles = []
    if text:
        box = font.getbbox(text, stroke_width=0)
        word = Image.new("L", (box[2] - box[0] + 4, box[3] - box[1] + 4))
        ImageDraw.Draw(word).text((2 - box[0], 2 - box[1]), text, font=font, fill=255,
                                  stroke_width=int(rng.integers(0, 3)))
        high = height * rng.uniform(0.38, 0.68)
        wide = min(high * word.width / word.height * rng.uniform(0.8, 1.2), 0.88 * width)
        high = min(high, wide * word.height / word.width * 1.3)
        word = word.resize((max(2, int(wide)), max(2, int(high))))
        at = (int((width - word.width) / 2 + rng.normal(0, 0.02) * width),
              int((height - word.height) / 2 + rng.normal(0, 0.03) * height))
        face.paste(Image.new("RGB", word.size, tuple(ink)), at, word)
        ends = [font.getlength(text[:k]) / font.getlength(text) for k in range(len(text) + 1)]
        middles = [at[0] + word.width * 0.5 * (a + b) for a, b in zip(ends, ends[1:])]
    return face, np.array(middles)


def rendered(rng, font_list):
    """A patch, its text, and the column of each letter's middle."""
    fine = 4
    text = "" if rng.random() < 0.06 else random_text(rng)
    font = font_list[rng.integers(len(font_list))]
    back, ink = rng.integers(0, 256, 3), rng.integers(0, 256, 3)
    if rng.random() < 0.6:  # white on a colour, or a colour on grey
        light = np.clip(rng.integers(150, 256) + rng.normal(0, 6, 3), 0, 255).astype(int)
        back, ink = (back, light) if rng.random() < 0.6 else (light, ink)
    if np.abs(back - ink).sum() < 90:
        ink = 255 - back
    canvas = Image.new("RGB", (fine * WIDTH, fine * HEIGHT), tuple(rng.integers(0, 256, 3)))
    draw = ImageDraw.Draw(canvas)
    for _ in range(rng.integers(0, 6)):  # surroundings
        x, y = rng.integers(0, canvas.width), rng.integers(0, canvas.height)
        w, h = rng.integers(4, 120, 2)
        draw.rectangle((x, y, x + w, y + h), fill=tuple(rng.integers(0, 256, 3)))
    high = fine * rng.uniform(26, 38)
    wide = float(np.clip(high * rng.uniform(0.55, 1.9), fine * 14, fine * 82))
    size = (int(wide), int(high))
    x, y = (canvas.width - size[0]) // 2, (canvas.height - size[1]) // 2
    # The pillar above and below, and its next face beside, in another light.
    pillar = tuple(rng.integers(0, 256, 3))
    draw.rectangle((x, 0, x + size[0], canvas.height), fill=pillar)
    face, middles = plate(rng, text, font, size, back, ink)
    canvas.paste(face, (x, y))
    if rng.random() < 0.5:
        light = rng.uniform(0.4, 1.6)
        beside, _ = plate(rng, text if rng.random() < 0.75 else "", font, size,
                          np.clip(back * light, 0, 255).astype(int),
                          np.clip(ink * light, 0, 255).astype(int))
        beside = beside.resize((max(2, int(size[0] * rng.uniform(0.1, 0.7))), size[1]))
        canvas.paste(beside, (x + size[0], y) if rng.random() < 0.5 else (x - beside.width, y))
    width_px = wide / fine
    canvas, inverse = warp(rng, canvas, 0.06, 0.05)
    points = np.stack([x + middles, np.full(len(middles), 0.5 * canvas.height), 1 + 0 * middles])
    middles = (inverse @ points)[0] / fine
    blur = fine * abs(rng.normal(0, 0.7))
    patch = canvas.filter(ImageFilter.GaussianBlur(blur)).resize((WIDTH, HEIGHT), Image.BOX)
    # What a far or slanted face gives: few columns and rows.
    keep = rng.uniform(0.25, 1.0, 2)
    if rng.random() < 0.6:
        small = patch.resize((max(8, int(WIDTH * keep[0])), max(6, int(HEIGHT * keep[1]))),
                             Image.BOX)
        patch = small.resize((WIDTH, HEIGHT), Image.BILINEAR)
    pixels = np.asarray(patch, np.float32) * rng.uniform(0.05, 1.0)
    pixels += rng.normal(0, rng.uniform(0.3, 5.0), pixels.shape)
    # Outlines are not exact.
    width_px *= rng.uniform(0.97, 1.15)
    return normalised(np.clip(np.rint(pixels), 0, 255), width_px), text, middles


def warp(rng, image, turn, shift):
    """Turned and sheared by `turn`, moved by `shift` of the height, one standard deviation each; and
    the matrix that takes points along."""
    a = 1.0 + rng.normal(0, 0.05)
    e = 1.0 + rng.normal(0, 0.05)
    b, d = rng.normal(0, turn, 2)
    cx, cy = image.width / 2, image.height / 2
    dx, dy = rng.normal(0, shift * image.height, 2)
    matrix = np.array([[a, b, cx - a * cx - b * cy + dx], [d, e, cy - d * cx - e * cy + dy],
                       [0, 0, 1]])
    out = image.transform(image.size, Image.AFFINE, matrix[:2].ravel(), Image.BILINEAR,
                          fillcolor=(128, 128, 128))
    return out, np.linalg.inv(matrix)


def normalised(pixels, width):
    """As the program does: mean 128 and spread 40 on the face, grey beside it."""
    half = int(np.clip(0.5 * width, 4, WIDTH // 2))
    face = pixels[3 : HEIGHT - 3, WIDTH // 2 - half : WIDTH // 2 + half].reshape(-1, 3)
    spread = max(1.5, float(np.sqrt(face.var(0).mean())))
    out = np.clip(np.rint(128 + 40 / spread * (pixels - face.mean(0))), 0, 255).astype(np.uint8)
    margin = 1 + 2 * half // 16
    out[:, : max(0, WIDTH // 2 - half - margin)] = 128
    out[:, WIDTH // 2 + half + margin :] = 128
    return out


NUMBERS = ("number", "turned")
SIGNS = ("guide", "limit")
NUMBERS_WEIGHT = 3.0  # they are fewer than faces, and read from one view each
SIGNS_WEIGHT = 8.0  # a hundredth of the faces


def text_weight(row):
    """How often a patch is learnt from: far ones cannot be read; plain ones are many."""
    if row["kind"] in NUMBERS:
        return NUMBERS_WEIGHT
    if row["kind"] in SIGNS:
        return SIGNS_WEIGHT
    if float(row["height_px"]) <= 9.0 or (row["text"] and float(row["distance_m"]) >= 16.0):
        return 0.0
    return 1.0 if row["text"] else 0.35


def shares_read(right, texts, kinds, distances, heights):
    """As a text: the share read rightly of faces by distance, of plain ones, of signs and of numbers."""
    kinds, written = np.asarray(kinds), np.array([bool(text) for text in texts])
    distances, heights = np.asarray(distances), np.asarray(heights)
    face = ~np.isin(kinds, NUMBERS + SIGNS)
    near = written & (distances < 10)
    groups = [(f"{low}-{high} m", face & written & (distances >= low) & (distances < high))
              for low, high in ((0, 6), (6, 10), (10, 15))]
    groups += [("plain", face & ~written & (heights > 9.0)), ("guide", near & (kinds == "guide")),
               ("limit", near & (kinds == "limit")), ("numbers", kinds == "number"),
               ("upside down", kinds == "turned")]
    return ", ".join(f"{name} {right[chosen].mean():.3f} of {chosen.sum()}"
                     for name, chosen in groups if chosen.any())


def text_files(folder):
    """Those of make_data.py --texts in a folder."""
    return glob.glob(os.path.join(folder, "g*", "*_texts.csv"))


class Crops:
    """Faces, signs and numbers that the simulator drew, straightened by the program. kinds: what they were
    cut out by (parkade bench semantics --texts)."""

    def __init__(self, folders, wanted):
        self.patches, self.texts, self.heights, self.distances, self.kinds = [], [], [], [], []
        weights = []
        for path in sorted(path for folder in folders for path in text_files(folder)):
            if not wanted(int(os.path.basename(os.path.dirname(path))[1:])):
                continue
            with open(path) as file:
                rows = list(csv.DictReader(file))
            strip = np.asarray(Image.open(path[:-4] + ".png").convert("RGB"))
            for i, row in enumerate(rows):
                self.patches.append(strip[HEIGHT * i : HEIGHT * (i + 1)])
                self.texts.append(row["text"])
                self.heights.append(float(row["height_px"]))
                self.distances.append(float(row["distance_m"]))
                self.kinds.append(row["kind"])
                weights.append(text_weight(row))
        self.heights, self.distances = np.array(self.heights), np.array(self.distances)
        self.kinds, self.weights = np.array(self.kinds), np.array(weights)
        if self.weights.sum() > 0:
            self.weights = self.weights / self.weights.sum()

    def __len__(self):
        return len(self.texts)


def augmented(rng, patch):
    """A patch as other light, colours and a slightly wrong outline would give it, and the matrix
    that takes points along."""
    image, moved = warp(rng, Image.fromarray(patch), 0.03, 0.04)
    if rng.random() < 0.3:
        image = image.filter(ImageFilter.GaussianBlur(abs(rng.normal(0, 0.8))))
    pixels = np.asarray(image, np.float32)[..., rng.permutation(3)]
    pixels = 128 + (pixels - 128) * np.exp(rng.normal(0, 0.2)) + rng.normal(0, 10)
    if rng.random() < 0.15:
        pixels = 256 - pixels
    if rng.random() < 0.4:
        pixels = pixels + rng.normal(0, rng.uniform(0, 14), pixels.shape)
    return np.clip(np.rint(pixels), 0, 255).astype(np.uint8), moved
