#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Blends the weights of a text reader and of one that was trained on from it.

    tools/train/blend.py models/zone_text.onnx RUN/text.pt --share 0.7 --out BLEND/text.pt

What a network learnt on new data keeps more of what it knew before where its weights are moved back
a part of the way (M. Wortsman et al., "Robust fine-tuning of zero-shot models", CVPR 2022). Takes
states and exported files; export_text.py writes the result as ONNX.
"""
import argparse
import os
import sys

import torch

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from export_text import fold  # noqa: E402
from text_network import TextNetwork, name_of  # noqa: E402
from warm_start import load, stored_weights, with_idle_norms  # noqa: E402


def folded(path, name):
    """The weights as exported: batch norms lie in the convolutions, and do nothing by themselves."""
    network = TextNetwork(name)
    state = load(path, network)
    if path.endswith(".onnx"):
        return state
    network.load_state_dict(state)
    return with_idle_norms(path, fold(network.eval()).state_dict(), TextNetwork(name))


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
    name = name_of(stored_weights(a.after))
    before, after = folded(a.before, name), folded(a.after, name)
    blend = {key: value if not value.dtype.is_floating_point else
             torch.lerp(value, after[key], a.share) for key, value in before.items()}
    os.makedirs(os.path.dirname(a.out) or ".", exist_ok=True)
    torch.save({"average": blend, "step": 0}, a.out)


if __name__ == "__main__":
    main()
