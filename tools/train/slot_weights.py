#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Fits the weights of what speaks for and against slots (src/parkade/semantics/slots/slot_clues.hpp).

Logistic regression with a Gaussian prior over the candidates that `parkade bench semantics
--slot-trials` writes. Prints what they tell of every fifth of the garages, left out in turn, and writes
slot_weights.hpp. What others say against a candidate (doubt) depends on the weights in use:
build and repeat once.

With --keep the weights of a header written before stand, and only those of clues that it does not know are fitted.

Example:
  parkade bench semantics --garages random:440-499 --set frames=8 --slot-trials --out TRIALS
  tools/train/slot_weights.py TRIALS/slot_trials.csv --out src/parkade/semantics/slots/slot_weights.hpp
"""
import argparse
import csv
import pathlib
import re
import sys

import numpy as np

FOLDS = 5
# After the weights set by hand before: where candidates tell little, these stand.
BY_HAND = {"doubt": -1.0, "seen": 1.0, "way_floor": 2.0, "way_paint": -6.0, "paint_across": -5.0, "towards_car": 1.5,
           "away": -3.0, "lane_beyond": -4.0, "closed": 1.0, "t": 1.0, "l": 0.7, "stop_in_front": -6.0,
           "neighbours": 1.0, "pillar": -5.0}


def read(paths):
    names, rows = None, []
    for path in paths:
        try:
            with open(path, newline="") as file:
                header, *lines = list(csv.reader(file)) or [[]]
            if header[:3] != ["garage", "right", "doubt"] or "parallel" not in header:
                sys.exit(f"{path}: no slot_trials.csv of parkade bench semantics --slot-trials")
            if names not in (None, header[3:]):
                sys.exit(f"{path}: other columns than {paths[0]}")
            names = header[3:]
            rows += [[float(cell) for cell in line] for line in lines]
        except (OSError, ValueError) as error:
            sys.exit(f"{path}: {error}")
    if not rows or len({len(row) for row in rows}) != 1:
        sys.exit(f"{', '.join(paths)}: no candidates, or lines of different lengths")
    table = np.array(rows)
    garages = table[:, 0].astype(int)
    if len(set(garages % FOLDS)) < 2:
        sys.exit(f"{', '.join(paths)}: garages of one fold only (seed modulo {FOLDS}); give more garages")
    return names, garages, table[:, 1], table[:, 2:]  # doubt, clues...


def counts(names, inputs, right, along):
    """How often each candidate counts."""
    parallel = inputs[:, 1 + names.index("parallel")] > 0.5
    return np.where(parallel & (right > 0.5), along, 1.0)


def standing(path):
    """Weights by name, of a header that this program wrote."""
    try:
        text = pathlib.Path(path).read_text()
    except OSError as error:
        sys.exit(f"{path}: {error}")
    weights = {name: float(weight) for weight, name in re.findall(r"^ *(-?[\d.]+), *// (\w+)$", text, re.MULTILINE)}
    for name, sign, key in (("intercept", 1.0, "kSlotIntercept"), ("doubt", -1.0, "kSlotDoubtWeight")):
        found = re.search(rf"{key} = (-?[\d.]+);", text)
        if not found:
            sys.exit(f"{path}: no {key}; give a header that tools/train/slot_weights.py wrote")
        weights[name] = sign * float(found[1])
    return weights


def fit(names, inputs, right, count, prior, kept):
    """Weights of the inputs (doubt first) and the intercept."""
    x = np.hstack([inputs, np.ones((len(inputs), 1))])
    names = ["doubt", *names, "intercept"]
    precision = np.full(x.shape[1], prior)
    precision[-1] = 1e-3
    mean = np.array([BY_HAND.get(name, 0.0) for name in names])
    for i, name in enumerate(names):
        if name in kept:
            mean[i], precision[i] = kept[name], 1e9
    w = np.zeros(x.shape[1])
    for _ in range(40):
        p = 1.0 / (1.0 + np.exp(-x @ w))
        hessian = x.T @ (x * (count * p * (1.0 - p))[:, None]) + np.diag(precision)
        w += np.linalg.solve(hessian, x.T @ (count * (right - p)) - precision * (w - mean))
    return w[:-1], w[-1]


def log_loss(right, log_odds):
    return np.mean(np.logaddexp(0.0, np.where(right > 0.5, -log_odds, log_odds)))


def report(garages, right, log_odds):
    print(f"{len(right)} candidates of {len(set(garages))} garages, {right.mean():.3f} of them slots")
    print(f"log loss, garages left out: {log_loss(right, log_odds):.4f}")
    for least in (-1.0, 0.0, 0.85, 2.0):
        told = log_odds > least
        print(f"  told above {least:5.2f}: {right[told].sum():.0f} of {right.sum():.0f} slots, "
              f"{(1 - right[told]).sum():.0f} that are none")


def write(path, names, weights, intercept):
    numbers = [f"{weight:.3f}," for weight in weights[1:]]
    width = max(map(len, numbers))
    lines = [f"    {number:<{width}}  // {name}" for number, name in zip(numbers, names)]
    text = "\n".join([
        "// SPDX-FileCopyrightText: 2026 The Parkade authors",
        "// SPDX-License-Identifier: Apache-2.0", "#pragma once", "",
        '#include "parkade/semantics/slots/slot_clues.hpp"', "",
        "// Written by tools/train/slot_weights.py: do not edit.", "namespace parkade {", "",
        f"inline constexpr double kSlotIntercept = {intercept:.3f};",
        f"inline constexpr double kSlotDoubtWeight = {-weights[0]:.3f};",
        "inline constexpr SlotClues kSlotWeights = {", *lines, "};", "", "}  // namespace parkade", ""])
    pathlib.Path(path).write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trials", nargs="+", help="slot_trials.csv")
    parser.add_argument("--out", required=True, help="header to write")
    parser.add_argument("--prior", type=float, default=1.0,
                        help="precision of the prior on weights")
    parser.add_argument("--along", type=float, default=3.0,
                        help="slots along the aisle, rarer in these garages than elsewhere, count so often")
    parser.add_argument("--keep", help="header written before, whose weights stand")
    args = parser.parse_args()
    kept = standing(args.keep) if args.keep else {}
    names, garages, right, inputs = read(args.trials)
    count = counts(names, inputs, right, args.along)
    log_odds = np.zeros(len(right))
    for fold in range(FOLDS):
        out = garages % FOLDS == fold
        weights, intercept = fit(names, inputs[~out], right[~out], count[~out], args.prior, kept)
        log_odds[out] = inputs[out] @ weights + intercept
    report(garages, right, log_odds)
    weights, intercept = fit(names, inputs, right, count, args.prior, kept)
    print(f"one unit of doubt takes {-weights[0]:.2f}")
    write(args.out, names, weights, intercept)


if __name__ == "__main__":
    main()
