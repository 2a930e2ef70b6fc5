#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Trains the reader of zone texts on a graphics processor, for a given time.

    tools/train/train_text_device.py --data TEXTS --out RUN --minutes 25

As train_text.py, with patches that are changed on the device; garages that make_data.py finishes
meanwhile are taken in. Writes RUN/text.pt.
"""
import argparse
import concurrent.futures
import os
import sys
import time

import numpy as np
import torch
from torch.nn import functional as F

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from batch_augment import Draw, blurred, coarser  # noqa: E402
from classes import is_validation  # noqa: E402
from device_data import Growing, Reader, read_texts  # noqa: E402
from device_training import Clock, add_learning, check, learn  # noqa: E402
from text_data import fonts, rendered, shares_read, text_weight  # noqa: E402
from text_network import HEIGHT, MEAN, SCALE, WIDTH, WIDTHS, TextNetwork, encode, read  # noqa: E402
from warm_start import load, settle  # noqa: E402

LONGEST = 24  # letters of a patch


class Texts:
    def __init__(self, device):
        self.device = device
        self.patches, self.symbols, self.lengths = (Growing(device) for _ in range(3))
        self.weights, self.test = [], []

    def take(self, results):
        for seed, (patches, rows) in results:
            if is_validation(seed):
                self.test.append((patches, rows))
                continue
            fits = [k for k, row in enumerate(rows) if len(row["text"]) <= LONGEST]
            self.add(patches[fits], [rows[k]["text"] for k in fits],
                     [text_weight(rows[k]) for k in fits])
        if self.weights:
            self.weight = torch.tensor(self.weights, dtype=torch.float32, device=self.device)

    def add(self, patches, texts, weights):
        symbols = np.zeros((len(texts), LONGEST), np.int64)
        for row, text in zip(symbols, texts):
            row[: len(text)] = encode(text)
        self.patches.append(patches)
        self.symbols.append(symbols)
        self.lengths.append(np.array([len(text) for text in texts]))
        self.weights += weights

    def batch(self, size):
        chosen = torch.multinomial(self.weight, size, replacement=True)
        return (self.patches.rows()[chosen].permute(0, 3, 1, 2).float(),
                self.symbols.rows()[chosen], self.lengths.rows()[chosen])


def render_some(seed, count):
    rng, font_list = np.random.default_rng(seed), fonts()
    made = [rendered(rng, font_list)[:2] for _ in range(count)]
    return np.stack([patch for patch, _ in made]), [text for _, text in made]


def changed(patches):
    """Patches as other light, colours, distances and slightly wrong outlines would give them."""
    n, device = len(patches), patches.device
    draw = Draw(n, device)
    normal = lambda deviation: deviation * torch.randn(n, device=device)  # noqa: E731
    ratio = HEIGHT / WIDTH
    theta = torch.stack([
        torch.stack([1 + normal(0.05), normal(0.03) * ratio, normal(0.04) * ratio * 2], 1),
        torch.stack([normal(0.03) / ratio, 1 + normal(0.05), normal(0.04) * 2], 1)], 1)
    grid = F.affine_grid(theta, [n, 1, HEIGHT, WIDTH], align_corners=False)
    patches = F.grid_sample(patches - 128, grid, mode="bilinear", align_corners=False) + 128
    patches = torch.where(draw.chance(0.25), coarser(patches, 2.5), patches)
    patches = torch.where(draw.chance(0.35), blurred(patches, draw.normal(0, 0.8).abs(),
                                                     draw.normal(0, 1.1).abs()), patches)
    order = torch.rand(n, 3, device=device).argsort(1)[:, :, None, None]
    patches = torch.gather(patches, 1, order.expand(-1, -1, HEIGHT, WIDTH))
    patches = 128 + (patches - 128) * torch.exp(draw.normal(0, 0.2)) + draw.normal(0, 10)
    patches = torch.where(draw.chance(0.15), 256 - patches, patches)
    patches = torch.where(draw.chance(0.4), patches + torch.randn_like(patches) * draw.uniform(0, 14),
                          patches)
    return patches.clamp(0, 255).round()


@torch.no_grad()
def report(network, test, device):
    network.eval()
    patches = np.concatenate([part for part, _ in test])
    rows = [row for _, part in test for row in part]
    found = []
    for first in range(0, len(patches), 512):
        x = torch.from_numpy(patches[first : first + 512]).to(device).permute(0, 3, 1, 2).float()
        found += read((network((x - MEAN) * SCALE)).cpu())
    right = np.array([a == row["text"] for a, row in zip(found, rows)])
    return shares_read(right, [row["text"] for row in rows], [row["kind"] for row in rows],
                       [float(row["distance_m"]) for row in rows],
                       [float(row["height_px"]) for row in rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", nargs="+", required=True, help="folders of make_data.py with texts")
    parser.add_argument("--network", choices=list(WIDTHS), default="text-wide")
    parser.add_argument("--batch", type=int, default=256)
    parser.add_argument("--rendered", type=int, default=12000, help="rendered faces [12000]")
    parser.add_argument("--rendered-share", type=float, default=0.15, help="of a batch [0.15]")
    parser.add_argument("--begin-with", type=int, default=2000, help="patches to wait for at first")
    parser.add_argument("--readers", type=int, default=1)
    parser.add_argument("--warm-start", help="a text.pt or an exported .onnx to begin with")
    add_learning(parser)
    a = parser.parse_args()
    check(parser, a)
    os.makedirs(a.out, exist_ok=True)
    torch.manual_seed(a.seed)
    torch.backends.cudnn.benchmark = True
    with concurrent.futures.ProcessPoolExecutor(4) as pool:
        parts = list(pool.map(render_some, range(1000, 1000 + a.rendered // 500),
                              [500] * (a.rendered // 500)))
    reader = Reader(a.data, read_texts, (), a.readers)
    reader.poll()
    clock = Clock(a.minutes, a.out)
    drawn, data = Texts(a.device), Texts(a.device)
    for patches, texts in parts:
        drawn.add(patches, texts, [1.0] * len(texts))
    drawn.weight = torch.ones(drawn.patches.count, device=a.device)
    while data.patches.count < a.begin_with or not data.test:
        data.take(reader.poll())
        time.sleep(0.5)
    make = lambda: TextNetwork(a.network).to(a.device)  # noqa: E731
    network = make()
    if a.warm_start:
        network.load_state_dict(load(a.warm_start, network))
    if a.warm_start and a.warm_start.endswith(".onnx"):
        settle(network, [(data.batch(a.batch)[0] - MEAN) * SCALE for _ in range(8)])
    of_drawn = int(a.rendered_share * a.batch)

    @torch.no_grad()
    def next_batch():
        both = [drawn.batch(of_drawn), data.batch(a.batch - of_drawn)]
        patches, symbols, lengths = (torch.cat(pair) for pair in zip(*both))
        return (changed(patches) - MEAN) * SCALE, symbols, lengths

    def loss_of(patches, symbols, lengths):
        with torch.autocast(torch.device(a.device).type, dtype=torch.bfloat16):
            logits = network(patches)
        log_p = F.log_softmax(logits.float()[:, :, 0], 1).permute(2, 0, 1)
        steps = torch.full((a.batch,), log_p.shape[0], device=a.device)
        return F.ctc_loss(log_p, symbols, steps, lengths, reduction="sum",
                          zero_infinity=True) / a.batch

    learn(a, clock, network, make, next_batch, loss_of, lambda: data.take(reader.poll()),
          lambda best, done: f"{data.patches.count} patches  {report(best, data.test, a.device)}",
          os.path.join(a.out, "text.pt"), {}, record=False)  # the loss asks the device for lengths
    reader.pool.shutdown(wait=False, cancel_futures=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
