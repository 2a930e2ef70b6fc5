#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Trains a segmentation network on samples of make_data.py, on the processor.

    tools/train/train.py --data DATA --network bev --out RUN --steps 10000

Writes RUN/state.pt every few minutes: the same command goes on from there. --warm-start FILE begins
with the weights of another run, or of a network that was exported. Samples that appear during
training are taken in. Garages whose seed ends in 3 are kept for validation.
"""
import argparse
import multiprocessing
import os
import queue
import sys
import time

# Threads that spin while they wait are slow where others want the processors.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")

import numpy as np  # noqa: E402
import torch  # noqa: E402

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from augment import augment  # noqa: E402
from classes import IGNORE, NETWORKS, is_validation  # noqa: E402
from dataset import Samples, as_labelled, cut, label_files  # noqa: E402
from network import PICTURES, full_size, make_network, name_of, to_input  # noqa: E402
from scores import Confusion, table  # noqa: E402
from warm_start import load, settle  # noqa: E402


def is_training(garage):
    return not is_validation(garage)


def make_batch(samples, rng, batch, size, network, plain):
    images, labels = [], []
    classes = NETWORKS[network]["classes"]
    floor, lines = (classes.index(name) if network == "bev" else None
                    for name in ("floor", "slot_line"))
    for _ in range(batch):
        index, centre = samples.pick(rng, size[0])
        if network == "raw":
            straight = None
            height, width = samples.labels[index].shape
            centre = ((0.5 + rng.uniform(-0.12, 0.12)) * width,
                      (0.5 + rng.uniform(-0.1, 0.1)) * height)
        else:
            straight = rng.random() < 0.6
        image, label = cut(samples.images[index], samples.labels[index], np.asarray(centre), size,
                           rng, straight)
        images.append(augment(rng, image, label, floor, lines, plain))
        labels.append(as_labelled(label, network))
    return np.stack(images), np.stack(labels)


class SegmentationLoss(torch.autograd.Function):
    """Weighted cross entropy plus 0.7 times Dice over the classes in the batch, on the network's
    half-size logits. The gradient is written out: automatic differentiation of the same takes
    longer than the network on a processor."""

    DICE = 0.7

    @staticmethod
    def forward(context, logits, labels, weight, row):
        """row: of the 2 x 2 block, 0 or 1; the other one has its turn in other steps."""
        n, channels, height, width = logits.shape
        classes = channels // 4
        # Class, row of the block, column of the block, place.
        p = logits.view(n, classes, 2, 2, height, width)[:, :, row]
        p = p.to(memory_format=torch.contiguous_format, copy=True).view(n, classes, -1)
        y = labels.view(n, height, 2, width, 2)[:, :, row].permute(0, 3, 1, 2)
        y = y.reshape(n, -1).long()
        known = (y != IGNORE).float()
        y = torch.where(y == IGNORE, torch.zeros_like(y), y)
        p.sub_(p.amax(1, keepdim=True)).exp_()
        p.div_(p.sum(1, keepdim=True))
        p_true = p.gather(1, y[:, None])[:, 0]
        w = weight[y] * known
        w /= w.sum().clamp(min=1e-6)
        entropy = -(w * p_true.clamp(min=1e-12).log()).sum()
        flat = y.flatten()
        overlap = torch.zeros(classes).scatter_add(0, flat, (p_true * known).flatten())
        truth = torch.zeros(classes).scatter_add(0, flat, known.flatten())
        mass = torch.einsum("nci,ni->c", p, known)
        present = (truth > 20).float()
        share = SegmentationLoss.DICE * present / present.sum().clamp(min=1.0)
        size = truth + mass + 1.0
        dice = (share * (1.0 - (2.0 * overlap + 1.0) / size)).sum()
        # d dice / d p = a_c + b_c [y = c]; through the softmax: p (g - sum_k g_k p_k).
        a, b = share * (2.0 * overlap + 1.0) / size**2, -2.0 * share / size
        mean = torch.einsum("nci,c->ni", p, a) + b[y] * p_true
        base = w - mean * known
        at_truth = b[y] * p_true * known - w
        p.mul_(a[None, :, None] * known[:, None] + base[:, None])
        p.scatter_add_(1, y[:, None], at_truth[:, None])
        context.save_for_backward(p)
        context.shape, context.row = logits.shape, row
        return entropy + dice

    @staticmethod
    def backward(context, gradient):
        n, channels, height, width = context.shape
        whole = torch.zeros(n, channels // 4, 2, 2, height, width)
        part = context.saved_tensors[0].view(n, channels // 4, 2, height, width)
        whole[:, :, context.row] = part * gradient
        return whole.view(context.shape), None, None, None


def class_weights(pixels):
    share = pixels / max(pixels.sum(), 1)
    weight = 1.0 / np.sqrt(np.maximum(share, 1e-5))
    weight = np.where(pixels > 0, weight, 0.0)
    # Mean 1 over pixels. Crops favour rare classes already: no class above four times another.
    weight = np.clip(weight, weight.max() / 4.0, None)
    return torch.tensor(weight / (weight * share).sum(), dtype=torch.float32)


def keep_making(batches, data, network, seed, batch, size, plain):
    """In a process of its own: batches without end, and how often the classes occur."""
    torch.set_num_threads(1)
    samples = Samples(data, network, is_training)
    rng = np.random.default_rng(seed)
    refreshed = time.time()
    while True:
        if time.time() - refreshed > 120:
            samples.refresh()
            refreshed = time.time()
        batches.put((*make_batch(samples, rng, batch, size, network, plain), samples.pixels,
                     len(samples.images)))


def next_batch(batches, maker, wait_s=10.0):
    """What keep_making made next; ends the program where its process, maker, has ended."""
    while True:
        try:
            return batches.get(timeout=wait_s)
        except queue.Empty:
            if not maker.is_alive():
                sys.exit("the process that makes batches has ended "
                         f"(exit code {maker.exitcode}); what it said stands above")


def validate(network, samples, limit):
    network.eval()
    confusion = Confusion(samples.num_classes)
    step = max(1, len(samples.images) // limit)
    with torch.no_grad():
        for i in range(0, len(samples.images), step):
            found = full_size(network(to_input(samples.images[i][None]))).argmax(1)[0]
            confusion.add(as_labelled(samples.labels[i], samples.network), found.numpy())
    network.train()
    return confusion.iou()


class Average:
    """Exponential mean of the weights, which is what gets exported."""

    def __init__(self, network, decay):
        self.decay = decay
        self.state = {k: v.clone() for k, v in network.state_dict().items()}

    def update(self, network, step):
        decay = min(self.decay, (1 + step) / (10 + step))
        for key, value in network.state_dict().items():
            if value.dtype.is_floating_point:
                self.state[key].mul_(decay).add_(value, alpha=1 - decay)
            else:
                self.state[key].copy_(value)


def save(path, content):
    torch.save(content, path + ".part")
    os.replace(path + ".part", path)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", required=True)
    parser.add_argument("--network", choices=list(PICTURES), required=True,
                        help="bev-deep: bev with residual blocks; raw: of the cameras' views")
    parser.add_argument("--out", required=True)
    parser.add_argument("--steps", type=int, default=10000, help="length of the training [10000]")
    parser.add_argument("--batch", type=int, default=6)
    parser.add_argument("--crop", type=int, default=256, help="side of a crop of bev, px [256]")
    parser.add_argument("--rate", type=float, default=2e-3, help="highest learning rate [0.002]")
    parser.add_argument("--plain", type=float, default=0.3,
                        help="share of pictures that stay nearly as they were drawn [0.3]")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--bfloat16", action="store_true",
                        help="half precision: twice as fast on processors that have it (avx512_bf16)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--warm-start",
                        help="a state.pt or an exported .onnx whose weights to begin with")
    a = parser.parse_args()
    pictures = PICTURES[a.network]
    if not label_files(a.data, pictures, is_training):
        parser.error(f"--data {a.data}: no pictures of make_data.py to train {a.network} on are there "
                     "(garages whose seed ends in 3 are for validation)")
    os.makedirs(a.out, exist_ok=True)
    torch.set_num_threads(a.threads)
    torch.manual_seed(a.seed)
    classes = NETWORKS[pictures]["classes"]
    size = NETWORKS[pictures]["size"] if pictures == "raw" else (a.crop, a.crop)

    test = Samples(a.data, pictures, is_validation)
    network = make_network(a.network, len(classes)).to(memory_format=torch.channels_last)
    optimiser = torch.optim.AdamW(network.parameters(), lr=a.rate, weight_decay=1e-3)
    step, spent = 0, 0.0
    path = os.path.join(a.out, "state.pt")
    average = Average(network, 0.998)
    if os.path.exists(path):
        state = torch.load(path)
        if name_of(state) != a.network:
            parser.error(f"--network {a.network}: {path}, to go on from, is of {name_of(state)}")
        network.load_state_dict(state["network"])
        optimiser.load_state_dict(state["optimiser"])
        average.state, step, spent = state["average"], state["step"], state["spent"]
    elif a.warm_start:
        network.load_state_dict(load(a.warm_start, network))
        if a.warm_start.endswith(".onnx"):
            rng = np.random.default_rng(a.seed)
            samples = Samples(a.data, pictures, is_training)
            settle(network, [to_input(make_batch(samples, rng, a.batch, size, pictures, a.plain)[0])
                             for _ in range(16)])
        average = Average(network, 0.998)
    log = open(os.path.join(a.out, "log.txt"), "a", buffering=1)

    def say(text):
        log.write(text + "\n")
        print(text, flush=True)

    say(f"{len(test.images)} validation pictures, "
        f"{sum(p.numel() for p in network.parameters())} parameters, from step {step}")
    batches = multiprocessing.Queue(4)
    maker = multiprocessing.Process(
        target=keep_making, daemon=True,
        args=(batches, a.data, pictures, a.seed * 1000003 + step, a.batch, size, a.plain))
    maker.start()
    last, losses = time.time(), []
    saved = validated = spent
    while step < a.steps:
        done = step / a.steps
        rate = a.rate * min(1.0, (step + 1) / 200) * (0.5 * (1 + np.cos(np.pi * done)) + 0.005)
        for group in optimiser.param_groups:
            group["lr"] = rate
        images, labels, pixels, seen = next_batch(batches, maker)
        with torch.autocast("cpu", dtype=torch.bfloat16, enabled=a.bfloat16):
            logits = network(to_input(images))
        loss = SegmentationLoss.apply(logits.float(), torch.as_tensor(labels),
                                      class_weights(pixels), step % 2)
        optimiser.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimiser.step()
        step += 1
        average.update(network, step)
        losses.append(float(loss.detach()))
        now = time.time()
        spent += now - last
        last = now
        if spent - saved > 120 or step == a.steps:
            saved = spent
            save(path, {"network": network.state_dict(), "average": average.state, "step": step,
                        "optimiser": optimiser.state_dict(), "spent": spent,
                        "name": a.network, "classes": classes})
            test.refresh()
            say(f"step {step}  {spent / 60:.1f} min  loss {np.mean(losses):.3f}  rate {rate:.5f}  "
                f"{seen} pictures")
            losses = []
        if spent - validated > 900 or step == a.steps:
            validated = spent
            mean = make_network(a.network, len(classes)).to(memory_format=torch.channels_last)
            mean.load_state_dict(average.state)
            iou = validate(mean, test, 60 if step < a.steps else 100000)
            say(f"step {step}  mean IoU {np.nanmean(iou):.3f}  {table(classes, iou)}")
            last = time.time()
    return 0


if __name__ == "__main__":
    sys.exit(main())
