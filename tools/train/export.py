#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a trained network as ONNX with its class map, and compares the program's numbers with torch's.

    tools/train/export.py RUN/state.pt --out models/bev_segmentation

Writes OUT.onnx and OUT.yaml where the numbers agree. The comparison runs build/release/parkade_onnx_check (built with the
tests) on random pictures; --check none skips it.
"""
import argparse
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import warnings

import numpy as np
import onnx
import torch

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from classes import NETWORKS, PX_PER_LABEL  # noqa: E402
from network import (MEAN, PICTURES, SCALE, fold_batch_norm, make_network,  # noqa: E402
                     name_of)

METRES_PER_PX = {"bev": 0.04}
SIGNIFICANT_BITS = 8  # as bfloat16 has, in which they learn


def rounded(network):
    """The network with its kernels rounded to so many bits. The file stays as long, but packs to less than a half, which is
    what a repository grows by; scores stay the same in their third digit."""
    for tensor in network.state_dict().values():
        if tensor.dim() > 1:
            mantissa, exponent = torch.frexp(tensor)
            scale = 2.0 ** SIGNIFICANT_BITS
            tensor.copy_(torch.ldexp(torch.round(mantissa * scale) / scale, exponent))
    return network


def load(path):
    state = torch.load(path, map_location="cpu")
    name = name_of(state)
    network = make_network(name, len(state["classes"]))
    network.load_state_dict(state["average"])
    if state["classes"] != NETWORKS[PICTURES[name]]["classes"]:
        sys.exit(f"{path}: trained for other classes than classes.py lists")
    return rounded(fold_batch_norm(network.eval())), state


def export(network, pictures, path):
    width, height = NETWORKS[pictures]["size"]
    picture = torch.zeros(1, 3, height, width)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(network, picture, path, opset_version=12, do_constant_folding=True,
                          input_names=["picture"], output_names=["logits"])
    model = onnx.load(path)
    inline_constants(model.graph)
    onnx.checker.check_model(model)
    onnx.save(model, path)


def inline_constants(graph):
    """OpenCV 4.6 refuses Identity nodes of stored numbers, which the exporter makes of equal ones."""
    stored = {value.name: value for value in graph.initializer}
    for node in [n for n in graph.node if n.op_type == "Identity" and n.input[0] in stored]:
        copy = onnx.TensorProto()
        copy.CopyFrom(stored[node.input[0]])
        copy.name = node.output[0]
        graph.initializer.append(copy)
        stored[copy.name] = copy
        graph.node.remove(node)


def write_class_map(pictures, model, path):
    """model: the file that the class map at path is of."""
    width, height = NETWORKS[pictures]["size"]
    lines = [
        "# What the network takes and gives (docs/networks.md). Written by tools/train/export.py.",
        f"network: {os.path.basename(model)}",
        "input:",
        f"  width: {width}",
        f"  height: {height}",
        "  any_size: true",
        "  channels: rgb",
        f"  mean: {MEAN:g}",
        f"  scale: {SCALE:.9g}",
    ]
    if pictures in METRES_PER_PX:
        lines.append(f"  metres_per_px: {METRES_PER_PX[pictures]}")
        lines.append("unknown_is_unseen: true")
    else:
        lines.append("mirror: true")
    lines.append("classes: [" + ", ".join(NETWORKS[pictures]["classes"]) + "]")
    with open(path, "w") as file:
        file.write("\n".join(lines) + "\n")


@contextlib.contextmanager
def replacing(*paths):
    """Gives a path beside each to write to. The files take their places at the end; where something
    fails before, they are removed, and what was there stays."""
    parts = [path + ".part" for path in paths]
    try:
        yield parts
        for part, path in zip(parts, paths):
            os.replace(part, path)
    finally:
        for part in parts:
            if os.path.exists(part):
                os.remove(part)


def compare(network, sizes, onnx_path, program):
    """Ends the program where the program's logits differ from torch's, on random input of each size."""
    worst = 0.0
    with tempfile.TemporaryDirectory() as folder:
        for w, h in sizes:
            picture = np.random.default_rng(1).normal(size=(1, 3, h, w)).astype(np.float32)
            files = [os.path.join(folder, key) for key in ("in", "out")]
            picture.tofile(files[0])
            subprocess.run([program, onnx_path, str(w), str(h), *files], check=True)
            with torch.no_grad():
                expected = network(torch.from_numpy(picture)).numpy()
            found = np.fromfile(files[1], np.float32).reshape(expected.shape)
            worst = np.maximum(worst, np.abs(found - expected).max())  # also tells of NaN
            print(f"{w} x {h}: largest difference {np.abs(found - expected).max():.2g} of logits up "
                  f"to {np.abs(expected).max():.3g}")
    if not worst <= 1e-3:
        sys.exit(f"the program and torch differ by {worst:g}")


def parse_arguments(doc, state_help):
    parser = argparse.ArgumentParser(description=doc,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("state", help=state_help)
    parser.add_argument("--out", required=True, help="path without ending")
    parser.add_argument("--check", default="build/release/parkade_onnx_check",
                        help="parkade_onnx_check, which runs a network as the program does, or none")
    a = parser.parse_args()
    if a.check != "none" and shutil.which(a.check) is None:
        parser.error(f"--check {a.check}: no such program; it is built with the tests (none: no comparison)")
    return a


def main():
    a = parse_arguments(__doc__, "state.pt of a training")
    network, state = load(a.state)
    pictures = PICTURES[name_of(state)]
    model = a.out + ".onnx"
    with replacing(model, a.out + ".yaml") as (new_model, new_map):
        export(network, pictures, new_model)
        write_class_map(pictures, model, new_map)
        if a.check != "none":
            width, height = NETWORKS[pictures]["size"]
            step = 32 * PX_PER_LABEL[pictures]
            compare(network, [(width, height), (width - 2 * step, height - step)], new_model, a.check)
    print(f"{model}: {os.path.getsize(model) / 1e6:.2f} MB, {name_of(state)}, step {state['step']}")


if __name__ == "__main__":
    main()
