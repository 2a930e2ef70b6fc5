#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Trains the reader of zone texts and slots' numbers on rendered faces and on make_data.py --texts.

    tools/train/train_text.py --data TEXTS --out RUN

Writes RUN/text.pt. Garages whose seed ends in 3 are kept for validation; without --data it learns
from rendered faces alone. --check FILE only scores a state.
"""
import argparse
import os
import sys
import time

os.environ.setdefault("OMP_WAIT_POLICY", "passive")

import numpy as np  # noqa: E402
import torch  # noqa: E402

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from classes import is_validation  # noqa: E402
from text_data import Crops, augmented, fonts, rendered, shares_read, text_files  # noqa: E402
from text_network import WIDTHS, TextNetwork, column_loss, name_of, read, sequence_loss, to_input  # noqa: E402
from warm_start import load, settle, stored_weights  # noqa: E402


def render_many(rng, count):
    font_list = fonts()
    return [rendered(rng, font_list) for _ in range(count)]


def loss_of(rng, network, drawn, crops, size):
    """A third of a batch are rendered faces, learnt by column, since their letters' places are known,
    which starts the learning; the others are the simulator's, as sequences."""
    chosen = [drawn[i] for i in rng.integers(len(drawn), size=size // 3 if len(crops) else size)]
    patches, middles = [], []
    for patch, _, columns in chosen:
        patch, moved = augmented(rng, patch)
        points = np.stack([columns, np.full(len(columns), 20.0), np.ones(len(columns))])
        patches.append(patch)
        middles.append((moved @ points)[0])
    picked = rng.choice(len(crops), size - len(chosen), p=crops.weights) if len(crops) else []
    patches += [augmented(rng, crops.patches[i])[0] for i in picked]
    logits = network(to_input(np.stack(patches)))
    half = len(chosen)
    loss = column_loss(logits[:half], [text for _, text, _ in chosen], middles)
    if len(picked):
        loss = loss + sequence_loss(logits[half:], [crops.texts[i] for i in picked])
    return loss


def accuracy(network, patches, texts):
    found = []
    with torch.no_grad():
        for i in range(0, len(patches), 64):
            found += read(network(to_input(np.stack(patches[i : i + 64]))))
    return np.array([a == b for a, b in zip(found, texts)]), found


def report(network, crops, drawn):
    """Share read rightly: rendered faces; of the validation garages faces by distance, signs, numbers."""
    right, _ = accuracy(network, [p for p, _, _ in drawn], [t for _, t, _ in drawn])
    text = f"rendered {right.mean():.3f}"
    if len(crops):
        right, _ = accuracy(network, crops.patches, crops.texts)
        text += ", " + shares_read(right, crops.texts, crops.kinds, crops.distances, crops.heights)
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", nargs="*", default=[], help="folders of make_data.py --texts")
    parser.add_argument("--out", help="folder for text.pt")
    parser.add_argument("--check", help="only score this text.pt or exported .onnx")
    parser.add_argument("--network", choices=list(WIDTHS), default="text-wide")
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--batch", type=int, default=48)
    parser.add_argument("--rate", type=float, default=3e-3)
    parser.add_argument("--rendered", type=int, default=12000, help="rendered faces [12000]")
    parser.add_argument("--columns-only", type=int, default=400,
                        help="steps on rendered faces alone at first [400]")
    parser.add_argument("--warm-start",
                        help="begin with the weights of another text.pt or of an exported .onnx")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    a = parser.parse_args()
    if not a.out and not a.check:
        parser.error("say --out, the folder for text.pt, or --check")
    for folder in a.data:
        if not text_files(folder):
            parser.error(f"--data {folder}: no texts of make_data.py --texts are there")
    torch.set_num_threads(a.threads)
    torch.manual_seed(a.seed)
    rng = np.random.default_rng(a.seed)
    network = TextNetwork(name_of(stored_weights(a.check)) if a.check else a.network)
    if a.warm_start:
        network.load_state_dict(load(a.warm_start, network))
        if a.warm_start.endswith(".onnx"):
            faces = [patch for patch, _, _ in render_many(rng, 512)]
            settle(network, [to_input(np.stack(faces))])
    held_back = Crops(a.data, is_validation)
    drawn_check = render_many(np.random.default_rng(a.seed + 1000), 1000)
    if a.check:
        network.load_state_dict(load(a.check, network))
        print(report(network.eval(), held_back, drawn_check))
        return
    os.makedirs(a.out, exist_ok=True)
    crops = Crops(a.data, lambda garage: not is_validation(garage))
    drawn = render_many(rng, a.rendered)
    print(f"{len(crops)} faces and numbers, {len(held_back)} for validation, {len(drawn)} rendered; "
          f"{sum(p.numel() for p in network.parameters())} parameters", flush=True)
    optimiser = torch.optim.AdamW(network.parameters(), lr=a.rate, weight_decay=1e-2)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, a.rate, a.steps, pct_start=0.1)
    average = TextNetwork(a.network)
    average.load_state_dict(network.state_dict())
    start, losses = time.time(), []
    for step in range(1, a.steps + 1):
        network.train()
        with_crops = crops if step > a.columns_only else []
        loss = loss_of(rng, network, drawn, with_crops, a.batch)
        optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimiser.step()
        schedule.step()
        losses.append(float(loss.detach()))
        with torch.no_grad():
            keep = min(0.99, step / (step + 10.0))
            for mean, now in zip(average.state_dict().values(), network.state_dict().values()):
                mean.copy_(now if mean.dtype == torch.long else mean * keep + now * (1 - keep))
        if step % 200 == 0 or step == a.steps:
            print(f"step {step}, {time.time() - start:.0f} s: loss {np.mean(losses[-200:]):.3f}; "
                  f"{report(average.eval(), held_back, drawn_check)}", flush=True)
            torch.save({"average": average.state_dict(), "step": step},
                       os.path.join(a.out, "text.pt"))


if __name__ == "__main__":
    main()
