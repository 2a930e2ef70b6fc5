#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Trains a segmentation network on a graphics processor, for a given time.

    tools/train/train_device.py --data DATA --network bev-deep --out RUN --minutes 25

Pictures stay on the device and are changed there; garages that make_data.py finishes meanwhile are
taken in. Writes RUN/NETWORK.pt, which export.py reads. Garages whose seed ends in 3 are kept for
validation. Changing RUN/minutes, where that file is, changes how long it goes on.
"""
import argparse
import os
import sys
import time

import numpy as np
import torch
from torch.nn import functional as F

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from batch_augment import augment, transform  # noqa: E402
from classes import IGNORE, NETWORKS  # noqa: E402
from device_data import Pictures, Reader, read_pictures  # noqa: E402
from network import MEAN, PICTURES, SCALE, full_size, make_network  # noqa: E402
from scores import Confusion, table  # noqa: E402
from device_training import Clock, add_learning, check, learn  # noqa: E402
from train import class_weights  # noqa: E402
from warm_start import load, settle  # noqa: E402

DICE = 0.7


def segmentation_loss(logits, labels, weight):
    """Weighted cross entropy plus DICE times one minus the Dice of each class in the batch (SegmentationLoss
    of train.py)."""
    logits = full_size(logits.float())
    known = labels != IGNORE
    entropy = F.cross_entropy(logits, torch.where(known, labels, -100), weight=weight, ignore_index=-100)
    p = logits.softmax(1) * known[:, None]
    y = torch.where(known, labels, 0)
    classes = logits.shape[1]
    of_truth = p.gather(1, y[:, None])[:, 0]
    flat = y.flatten()
    overlap = torch.zeros(classes, device=p.device).scatter_add(0, flat, of_truth.flatten())
    truth = torch.zeros(classes, device=p.device).scatter_add(0, flat, known.float().flatten())
    mass = p.sum((0, 2, 3))
    present = (truth > 20).float()
    dice = 1.0 - (2.0 * overlap + 1.0) / (truth + mass + 1.0)
    return entropy + DICE * (present * dice).sum() / present.sum().clamp(min=1.0)


class Echo:
    """Batches of pictures that were changed lately, each of which is seen so many times (data echoing, Choi et al. 2019):
    to change them takes longer than to learn from them. next_batch(): images and labels, changed anew."""

    def __init__(self, next_batch, times, views, kept=24):
        self.next_batch, self.times, self.views, self.kept = next_batch, times, views, kept
        self.images, self.labels, self.calls, self.filled = None, None, 0, 0

    def _add(self, images, labels):
        if self.images is None:
            self.images = images.new_empty((self.kept, *images.shape))
            self.labels = torch.empty((self.kept, *labels.shape), dtype=torch.uint8, device=labels.device)
        self.images[self.filled % self.kept].copy_(images)
        self.labels[self.filled % self.kept].copy_(labels)
        self.filled += 1

    @torch.no_grad()
    def __call__(self):
        while self.filled < 4 or self.filled * self.times <= self.calls:
            self._add(*self.next_batch())
        self.calls += 1
        size = self.images.shape[1]
        chosen = torch.randint(min(self.filled, self.kept) * size, (size,), device=self.images.device)
        images, labels = self.images.flatten(0, 1)[chosen], self.labels.flatten(0, 1)[chosen]
        for side in (1,) if self.views else (0, 1):
            if torch.rand(1) < 0.5:
                images, labels = images.flip(2 + side), labels.flip(1 + side)
        return images, labels.long()


@torch.no_grad()
def validate(network, data, device, limit):
    network.eval()
    images = np.concatenate(data.test_images)
    labels = np.concatenate(data.test_labels)
    step = max(1, len(images) // limit)
    confusion = Confusion(data.num_classes)
    for first in range(0, len(images), 16 * step):
        part = slice(first, first + 16 * step, step)
        x = torch.from_numpy(images[part]).to(device).permute(0, 3, 1, 2).float()
        x = ((x - MEAN) * SCALE).contiguous(memory_format=torch.channels_last)
        confusion.add(labels[part], full_size(network(x)).argmax(1).cpu().numpy())
    return confusion.iou(), len(images[::step])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", nargs="+", required=True, help="folders of make_data.py")
    parser.add_argument("--network", choices=list(PICTURES), required=True)
    parser.add_argument("--batch", type=int, default=32)
    parser.add_argument("--plain", type=float, default=0.4,
                        help="share of pictures that stay nearly as they were drawn [0.4]")
    parser.add_argument("--begin-with", type=int, default=200, help="pictures to wait for at first [200]")
    parser.add_argument("--readers", type=int, default=2, help="processes that read pictures [2]")
    parser.add_argument("--warm-start", help="a state file or an exported .onnx to begin with")
    parser.add_argument("--echo", type=int, default=1, help="times that each changed picture is learnt from [1]")
    add_learning(parser)
    a = parser.parse_args()
    check(parser, a)
    os.makedirs(a.out, exist_ok=True)
    torch.manual_seed(a.seed)
    torch.backends.cudnn.benchmark = True
    pictures = PICTURES[a.network]
    classes = NETWORKS[pictures]["classes"]
    reader = Reader(a.data, read_pictures, (pictures,), a.readers)
    reader.poll()  # its processes begin before the device is in use
    clock = Clock(a.minutes, a.out)
    data = Pictures(a.device, len(classes))
    while data.images.count < a.begin_with or not data.test_images:
        data.take(reader.poll())
        time.sleep(0.5)
    make = lambda: make_network(a.network, len(classes)).to(  # noqa: E731
        a.device, memory_format=torch.channels_last)
    network = make()
    if a.warm_start:
        network.load_state_dict(load(a.warm_start, network))
    if a.warm_start and a.warm_start.endswith(".onnx"):
        settle(network, [((data.batch(a.batch)[0] - MEAN) * SCALE) for _ in range(8)])
    floor, lines = ((classes.index("floor"), classes.index("slot_line")) if pictures == "bev"
                    else (None, None))
    print(f"{a.network}: {sum(p.numel() for p in network.parameters())} parameters, "
          f"{data.images.count} pictures after {clock.elapsed():.0f} s", flush=True)

    weight = class_weights(data.pixels).to(a.device)

    def take():
        data.take(reader.poll())
        weight.copy_(class_weights(data.pixels))

    @torch.no_grad()
    def next_batch():
        images, labels = data.batch(a.batch)
        images, labels = transform(images, labels, IGNORE, 0.6, pictures == "raw")
        return (augment(images, labels, floor, lines, a.plain) - MEAN) * SCALE, labels

    def loss_of(images, labels):
        with torch.autocast(torch.device(a.device).type, dtype=torch.bfloat16, cache_enabled=False):
            logits = network(images.contiguous(memory_format=torch.channels_last))
        return segmentation_loss(logits, labels, weight)

    def judge(best, done):
        iou, count = validate(best, data, a.device, 200 if done < 1.0 else 1000)
        return (f"{data.images.count} pictures  mean IoU {np.nanmean(iou):.3f} of {count}  "
                f"{table(classes, iou)}")

    feed = Echo(next_batch, a.echo, pictures == "raw") if a.echo > 1 else next_batch
    learn(a, clock, network, make, feed, loss_of, take, judge,
          os.path.join(a.out, a.network + ".pt"), {"name": a.network, "classes": classes})
    reader.pool.shutdown(wait=False, cancel_futures=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
