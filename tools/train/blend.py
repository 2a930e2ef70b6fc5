#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Moves a network that was trained on from another one back towards it.

    tools/train/blend.py models/zone_text.onnx RUN/text.pt --share 0.7 --out BLEND/text.pt

What it learnt stays for the most part, and what it knew before comes back: on pictures unlike those that it
learnt from last, the blend is often better than both (Wortsman et al., Robust fine-tuning of zero-shot models,
2022). export.py and export_text.py read what it writes.
"""
import argparse
import os
import sys

import torch

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from classes import NETWORKS  # noqa: E402
from export_text import fold  # noqa: E402
from network import PICTURES, fold_batch_norm, make_network, network_of  # noqa: E402
from text_network import TextNetwork, name_of  # noqa: E402
from warm_start import load, stored_weights, with_idle_norms  # noqa: E402


def maker_of(path):
    """What makes a network such as that of path, what folds its batch norms, and what else its state says."""
    weights = stored_weights(path)
    if "layers.0.0.weight" in weights:
        name = name_of(weights)
        return lambda: TextNetwork(name), fold, {}
    name, count = network_of(weights)
    said = {"name": name, "classes": NETWORKS[PICTURES[name]]["classes"]}
    return lambda: make_network(name, count), fold_batch_norm, said


def folded(path, make, fold_norms):
    """The weights as exported: batch norms lie in the convolutions, and do nothing by themselves."""
    network = make()
    state = load(path, network)
    if path.endswith(".onnx"):
        return state
    network.load_state_dict(state)
    return with_idle_norms(path, fold_norms(network.eval()).state_dict(), make())


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", help="text.pt or exported .onnx")
    parser.add_argument("after", help="the same of the one trained on from it")
    parser.add_argument("--share", type=float, default=0.7, help="of the one trained on [0.7]")
    parser.add_argument("--out", required=True, help="state file to write")
    a = parser.parse_args()
    if not 0.0 <= a.share <= 1.0:
        parser.error(f"--share {a.share} is not between 0 and 1")
    make, fold_norms, said = maker_of(a.after)
    before, after = folded(a.before, make, fold_norms), folded(a.after, make, fold_norms)
    blend = {key: value if not value.dtype.is_floating_point else
             torch.lerp(value, after[key], a.share) for key, value in before.items()}
    os.makedirs(os.path.dirname(a.out) or ".", exist_ok=True)
    torch.save({"average": blend, "step": 0, **said}, a.out)


if __name__ == "__main__":
    main()
