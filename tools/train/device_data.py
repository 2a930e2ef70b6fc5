# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Samples of make_data.py on the device that learns from them. Garages are read by processes of their
own when they are done, also those that are drawn while the training runs."""
import concurrent.futures
import csv
import glob
import os

import numpy as np
import torch
from PIL import Image

from classes import NETWORKS, is_validation, label_table
from text_network import HEIGHT


def read_pictures(folder, pictures):
    """(images, labels) of a garage's folder, bytes; labels as the network tells them apart."""
    pattern = {"bev": "*_bev_labels.png", "raw": "*_raw?_labels.png"}[pictures]
    size = NETWORKS[pictures]["size"]
    table = label_table(pictures)
    images, labels = [], []
    for path in sorted(glob.glob(os.path.join(folder, pattern))):
        stem = path[: -len("_labels.png")]
        image = Image.open(stem + (".png" if os.path.exists(stem + ".png") else ".jpg"))
        label = Image.open(path)
        if image.size != size:
            image.draft("RGB", (2 * size[0], 2 * size[1]))
            image = image.convert("RGB").resize(size, Image.BOX)
            label = label.resize(size, Image.NEAREST)
        images.append(np.asarray(image.convert("RGB")))
        labels.append(table[np.asarray(label)])
    return (np.stack(images), np.stack(labels)) if images else None


def read_texts(folder):
    """(patches, rows of their tables) of a garage's folder."""
    patches, rows = [], []
    for path in sorted(glob.glob(os.path.join(folder, "*_texts.csv"))):
        with open(path) as file:
            table = list(csv.DictReader(file))
        strip = np.asarray(Image.open(path[:-4] + ".png").convert("RGB"))
        patches.append(strip[: HEIGHT * len(table)].reshape(len(table), HEIGHT, -1, 3))
        rows += table
    return (np.concatenate(patches), rows) if rows else None


class Growing:
    """Rows of arrays on a device, appended to without copying all of them each time."""

    def __init__(self, device):
        self.device, self.store, self.count = device, None, 0

    def append(self, rows):
        rows = torch.from_numpy(np.ascontiguousarray(rows)).to(self.device)
        need = self.count + len(rows)
        if self.store is None or need > len(self.store):
            grown = torch.empty((max(2 * need, 1024), *rows.shape[1:]), dtype=rows.dtype,
                                device=self.device)
            if self.store is not None:
                grown[: self.count] = self.store[: self.count]
            self.store = grown
        self.store[self.count : need] = rows
        self.count = need

    def rows(self):
        return self.store[: self.count]


class Reader:
    """Reads garages in the background. poll() gives what was read since, one result a garage."""

    def __init__(self, folders, read, arguments, workers):
        self.folders, self.read, self.arguments = folders, read, arguments
        self.pool = concurrent.futures.ProcessPoolExecutor(workers)
        self.known, self.waiting = set(), []

    def poll(self):
        for folder in self.folders:
            for mark in sorted(glob.glob(os.path.join(folder, "g*", "done"))):
                if mark not in self.known:
                    self.known.add(mark)
                    garage = os.path.dirname(mark)
                    self.waiting.append((int(os.path.basename(garage)[1:]), self.pool.submit(
                        self.read, garage, *self.arguments)))
        done = [(seed, job.result()) for seed, job in self.waiting if job.done()]
        self.waiting = [(seed, job) for seed, job in self.waiting if not job.done()]
        return [(seed, result) for seed, result in done if result is not None]


class Pictures:
    """Training and validation pictures of one kind; garages whose seed ends in 3 are for validation."""

    def __init__(self, device, num_classes):
        self.images, self.labels = Growing(device), Growing(device)
        self.test_images, self.test_labels = [], []
        self.num_classes, self.counts, self.device = num_classes, [], device

    def take(self, results):
        for seed, (images, labels) in results:
            if is_validation(seed):
                self.test_images.append(images)
                self.test_labels.append(labels)
                continue
            self.images.append(images)
            self.labels.append(labels)
            self.counts += [np.bincount(one.ravel(), minlength=256)[: self.num_classes]
                            for one in labels]
        if results and self.counts:
            self._weigh()

    def _weigh(self):
        """A third of the draws fall on any picture, the others on a class by the inverse square root
        of how many pictures show it."""
        counts = np.array(self.counts)
        has = (counts > 30).astype(float)
        shown = has.sum(0)
        of_class = np.where(shown > 0, 1.0 / np.sqrt(np.maximum(shown, 1.0)), 0.0)
        of_class[0] *= 0.2  # unknown
        of_class /= of_class.sum()
        weight = 0.35 / len(has) + 0.65 * has @ (of_class / np.maximum(shown, 1.0))
        self.weight = torch.tensor(weight, dtype=torch.float32, device=self.device)
        self.pixels = counts.sum(0)

    def batch(self, size):
        """Float images N x 3 x H x W and labels N x H x W."""
        chosen = torch.multinomial(self.weight, size, replacement=True)
        return (self.images.rows()[chosen].permute(0, 3, 1, 2).float(),
                self.labels.rows()[chosen])
