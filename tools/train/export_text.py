#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a trained text reader as ONNX with its YAML file, and compares the program's numbers with torch's.

    tools/train/export_text.py RUN/text.pt --out models/zone_text

The comparison runs build/release/parkade_onnx_check (built with the tests); --check none skips it.
"""
import os
import sys
import warnings

import onnx
import torch
from torch.nn.utils.fusion import fuse_conv_bn_eval

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from export import compare, inline_constants, parse_arguments, replacing, rounded  # noqa: E402
from text_network import ALPHABET, HEIGHT, MEAN, SCALE, WIDTH, TextNetwork, name_of  # noqa: E402


def fold(network):
    """Batch norm into the convolutions."""
    for block in network.layers:
        if isinstance(block, torch.nn.Sequential):
            block[0] = fuse_conv_bn_eval(block[0], block[1])
            block[1] = torch.nn.Identity()
    return network


def export(network, path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(network, torch.zeros(1, 3, HEIGHT, WIDTH), path, opset_version=12,
                          do_constant_folding=True, input_names=["patch"],
                          output_names=["logits"])
    model = onnx.load(path)
    inline_constants(model.graph)
    onnx.checker.check_model(model)
    onnx.save(model, path)


def write_description(model, path):
    """model: the file that the description at path is of."""
    with open(path, "w") as file:
        file.write(
            "# What the network takes and gives (docs/networks.md). Written by "
            "tools/train/export_text.py.\n"
            f"network: {os.path.basename(model)}\n"
            f"input:\n  width: {WIDTH}\n  height: {HEIGHT}\n  mean: {MEAN:g}\n  scale: {SCALE:g}\n"
            f'letters: "{ALPHABET}"\n')


def main():
    a = parse_arguments(__doc__, "text.pt of a training")
    weights = torch.load(a.state, map_location="cpu")["average"]
    network = TextNetwork(name_of(weights))
    network.load_state_dict(weights)
    network = rounded(fold(network.eval()))
    model = a.out + ".onnx"
    with replacing(model, a.out + ".yaml") as (new_model, new_description):
        export(network, new_model)
        write_description(model, new_description)
        if a.check != "none":
            compare(network, [(WIDTH, HEIGHT)], new_model, a.check)
    print(f"{model}: {os.path.getsize(model) / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
