# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Intersection over union per class."""
import numpy as np

from classes import IGNORE


class Confusion:
    def __init__(self, num_classes):
        self.matrix = np.zeros((num_classes, num_classes), np.int64)

    def add(self, truth, found):
        keep = truth != IGNORE
        n = len(self.matrix)
        pairs = truth[keep].astype(np.int64) * n + found[keep]
        self.matrix += np.bincount(pairs, minlength=n * n).reshape(n, n)

    def iou(self):
        """NaN where a class does not occur."""
        hits = np.diag(self.matrix)
        union = self.matrix.sum(0) + self.matrix.sum(1) - hits
        occurs = self.matrix.sum(1) > 0
        return np.where(occurs, hits / np.maximum(union, 1), np.nan)


def table(classes, iou):
    return "  ".join(f"{name} {value:.2f}" for name, value in zip(classes, iou))
