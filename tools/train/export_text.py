#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a trained text reader as ONNX with its YAML file, and compares OpenCV's numbers with torch's.

    tools/train/export_text.py RUN/text.pt --out models/zone_text

The comparison runs build/release/parkade_onnx_check (built with the tests); --check none skips it.
"""
import argparse
import os
import subprocess
import sys
import tempfile
import warnings

import numpy as np
import onnx
import torch
from torch.nn.utils.fusion import fuse_conv_bn_eval

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from export import inline_constants  # noqa: E402
from text_network import ALPHABET, HEIGHT, MEAN, SCALE, WIDTH, TextNetwork  # noqa: E402


def fold(network):
    """Batch norm into the convolutions."""
    for block in network.layers:
        if isinstance(block, torch.nn.Sequential):
            block[0] = fuse_conv_bn_eval(block[0], block[1])
            block[1] = torch.nn.Identity()
    return network


def compare(network, path, program):
    """Largest difference between OpenCV's and torch's logits on random input."""
    with tempfile.TemporaryDirectory() as folder:
        picture = np.random.default_rng(1).normal(size=(1, 3, HEIGHT, WIDTH)).astype(np.float32)
        files = [os.path.join(folder, key) for key in ("in", "out")]
        picture.tofile(files[0])
        subprocess.run([program, path, str(WIDTH), str(HEIGHT), *files], check=True)
        with torch.no_grad():
            expected = network(torch.from_numpy(picture)).numpy()
        found = np.fromfile(files[1], np.float32).reshape(expected.shape)
    worst = float(np.abs(found - expected).max())
    print(f"largest difference {worst:.2g} of logits up to {np.abs(expected).max():.3g}")
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("state", help="text.pt of a training")
    parser.add_argument("--out", required=True, help="path without ending")
    parser.add_argument("--check", default="build/release/parkade_onnx_check",
                        help="program that runs the network in OpenCV, or none")
    a = parser.parse_args()
    network = TextNetwork()
    network.load_state_dict(torch.load(a.state, map_location="cpu")["average"])
    network = fold(network.eval())
    path = a.out + ".onnx"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(network, torch.zeros(1, 3, HEIGHT, WIDTH), path, opset_version=12,
                          do_constant_folding=True, input_names=["patch"],
                          output_names=["logits"])
    model = onnx.load(path)
    inline_constants(model.graph)
    onnx.checker.check_model(model)
    onnx.save(model, path)
    with open(a.out + ".yaml", "w") as file:
        file.write(
            "# What the network takes and gives (docs/networks.md). Written by "
            "tools/train/export_text.py.\n"
            f"network: {os.path.basename(path)}\n"
            f"input:\n  width: {WIDTH}\n  height: {HEIGHT}\n  mean: {MEAN:g}\n  scale: {SCALE:g}\n"
            f'letters: "{ALPHABET}"\n')
    print(f"{path}: {os.path.getsize(path) / 1e6:.2f} MB")
    if a.check != "none" and compare(network, path, a.check) > 1e-3:
        sys.exit("OpenCV and torch differ")


if __name__ == "__main__":
    main()
