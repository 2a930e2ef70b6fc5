# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Samples that make_data.py wrote, in memory; crops that favour rare classes."""
import glob
import os

import numpy as np
import torch
from PIL import Image
from torch.nn import functional as F

from classes import IGNORE, NETWORKS, PX_PER_LABEL, label_table


def label_files(folder, network, wanted):
    """Paths of the label images of a folder's garages that wanted(garage_seed) says yes to."""
    pattern = {"bev": "*_bev_labels.png", "raw": "*_raw?_labels.png"}[network]
    return [path for path in sorted(glob.glob(os.path.join(folder, "g*", pattern)))
            if wanted(garage_of(path))]


def garage_of(path):
    return int(os.path.basename(os.path.dirname(path))[1:])


class Samples:
    """Pictures and labels of a folder; refresh() takes in what was written since."""

    def __init__(self, folder, network, wanted):
        """wanted(garage_seed) says which garages belong to this set."""
        self.folder, self.network, self.wanted = folder, network, wanted
        self.table = label_table(network)
        self.num_classes = len(NETWORKS[network]["classes"])
        self.images, self.labels, self.garages, self.counts = [], [], [], []
        self.known = set()
        self.refresh()

    def refresh(self):
        for path in label_files(self.folder, self.network, self.wanted):
            if path in self.known:
                continue
            try:
                image, labels = self._read(path)
            except OSError:  # being written
                continue
            self.known.add(path)
            labels = self.table[labels]
            self.images.append(image)
            self.labels.append(labels)
            self.garages.append(garage_of(path))
            self.counts.append(np.bincount(labels.ravel(), minlength=256)[: self.num_classes])
        if self.counts:
            self.has = np.array(self.counts) > 30
            self.pixels = np.array(self.counts).sum(0)
        return len(self.images)

    def _read(self, path):
        stem = path[: -len("_labels.png")]
        labels = Image.open(path)
        image = Image.open(stem + (".png" if os.path.exists(stem + ".png") else ".jpg"))
        image = image.convert("RGB")
        if self.network == "raw":
            size = NETWORKS["raw"]["size"]
            image = image.resize(size, Image.BOX)
            labels = labels.resize(size, Image.NEAREST)
        return np.asarray(image), np.asarray(labels)

    def pick(self, rng, crop):
        """A sample's index and the middle (x, y) of a crop of it; rare classes come more often."""
        if rng.random() < 0.35:
            return self._anywhere(rng, crop)
        # A class by the inverse square root of how many pictures show it.
        shown = self.has.sum(0).astype(float)
        weight = np.where(shown > 0, 1.0 / np.sqrt(np.maximum(shown, 1.0)), 0.0)
        weight[0] *= 0.2  # unknown
        chosen = rng.choice(self.num_classes, p=weight / weight.sum())
        index = rng.choice(np.flatnonzero(self.has[:, chosen]))
        ys, xs = np.nonzero(self.labels[index] == chosen)
        k = rng.integers(len(ys))
        jitter = rng.uniform(-0.4, 0.4, 2) * crop
        # Most of a crop shall show something.
        height, width = self.labels[index].shape
        return index, (np.clip(xs[k] + jitter[0], 0.4 * crop, width - 0.4 * crop),
                       np.clip(ys[k] + jitter[1], 0.4 * crop, height - 0.4 * crop))

    def _anywhere(self, rng, crop):
        index = rng.integers(len(self.images))
        height, width = self.labels[index].shape
        return index, (rng.uniform(crop / 2, max(width - crop / 2, crop / 2 + 1)),
                       rng.uniform(crop / 2, max(height - crop / 2, crop / 2 + 1)))


def cut(image, labels, centre, size, rng, straight):
    """A crop of size (width, height) around centre. straight: the pixels themselves, mirrored either
    way; else turned and scaled: half of these by any angle, half by some degrees, since cars stand
    along the lines or across them most of the time."""
    width, height = size
    if straight is None:
        angle, scale = 0.0, rng.uniform(0.75, 1.15)
    elif straight:
        return mirrored_cut(image, labels, centre, size, rng.random() < 0.5, rng.random() < 0.5)
    else:
        angle = rng.uniform(-np.pi, np.pi) if rng.random() < 0.5 else rng.normal(0.0, 0.15)
        scale = np.exp(rng.normal(0.0, 0.12))
    mirror = -1.0 if rng.random() < 0.5 else 1.0
    c, s = np.cos(angle) / scale, np.sin(angle) / scale
    v, u = np.mgrid[0:height, 0:width].astype(np.float32)
    u, v = mirror * (u - 0.5 * (width - 1)), v - 0.5 * (height - 1)
    x, y = c * u - s * v + centre[0], s * u + c * v + centre[1]
    return sample_image(image, x, y), sample_labels(labels, x, y)


def mirrored_cut(image, labels, centre, size, upside_down, left_right):
    """The pixels themselves, of a square."""
    side = size[0]
    left, top = (int(np.floor(value)) - side // 2 for value in centre)
    x0, y0 = max(left, 0), max(top, 0)
    x1, y1 = min(left + side, labels.shape[1]), min(top + side, labels.shape[0])
    out = np.zeros((side, side, 3), image.dtype)
    classes = np.full((side, side), IGNORE, np.uint8)
    out[y0 - top : y1 - top, x0 - left : x1 - left] = image[y0:y1, x0:x1]
    classes[y0 - top : y1 - top, x0 - left : x1 - left] = labels[y0:y1, x0:x1]
    if upside_down:
        out, classes = out[::-1], classes[::-1]
    return (out[:, ::-1], classes[:, ::-1]) if left_right else (out, classes)


def as_labelled(labels, network):
    """Labels of a picture's pixels -> those that the network gives."""
    step = PX_PER_LABEL[network]
    return labels[..., step // 2 :: step, step // 2 :: step]


def sample_labels(labels, x, y):
    xi, yi = np.rint(x).astype(np.int32), np.rint(y).astype(np.int32)
    inside = (xi >= 0) & (yi >= 0) & (xi < labels.shape[1]) & (yi < labels.shape[0])
    out = np.full(x.shape, IGNORE, np.uint8)
    out[inside] = labels[yi[inside], xi[inside]]
    return out


def sample_image(image, x, y):
    """Bilinear; black outside."""
    height, width = image.shape[:2]
    grid = np.stack([(2 * x + 1) / width - 1, (2 * y + 1) / height - 1], -1).astype(np.float32)
    picture = torch.from_numpy(np.ascontiguousarray(image.transpose(2, 0, 1))).float()
    out = F.grid_sample(picture[None], torch.from_numpy(grid)[None], align_corners=False)
    return out[0].permute(1, 2, 0).numpy()
