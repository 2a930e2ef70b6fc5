# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Weights to begin a training with: those of an earlier one, or of a network that was exported."""
import torch
from torch import nn

from network import grown


def blocks_of(network):
    """(name, convolution, batch norm) of each pair in the network."""
    for name, module in network.named_modules():
        parts = list(module.children()) if isinstance(module, nn.Sequential) else []
        if len(parts) > 1 and isinstance(parts[0], nn.Conv2d) and isinstance(parts[1], nn.BatchNorm2d):
            yield name, parts[0], parts[1]


def stored_weights(path):
    """By name, of a state file or of an ONNX file."""
    if not path.endswith(".onnx"):
        return torch.load(path, map_location="cpu")["average"]
    import onnx
    from onnx import numpy_helper

    return {value.name: torch.from_numpy(numpy_helper.to_array(value).copy())
            for value in onnx.load(path).graph.initializer}


def load(path, network):
    """The state dict of path, a state file or an ONNX file that export.py or export_text.py wrote.
    Of the latter `settle` must find the batch norms' means and spreads before training. Where the
    network is larger (letters or blocks were added), what is new begins anew."""
    stored = stored_weights(path)
    if path.endswith(".onnx"):
        return with_idle_norms(path, stored, network)
    fresh = network.state_dict()
    refuse_larger(path, stored, fresh)
    return grown(stored, fresh)


def refuse_larger(path, stored, fresh):
    """Ends the program where weights by name, of path, do not fit into those of a fresh network."""
    unknown = [key for key, value in stored.items()
               if key not in fresh or any(a > b for a, b in zip(value.shape, fresh[key].shape))]
    if unknown:
        raise SystemExit(f"{path}: made by another network than this one ({', '.join(unknown)})")


def with_idle_norms(path, stored, network):
    """The state dict of a network whose batch norms were folded into the convolutions, as for export:
    what is left of them does nothing. stored: its weights by name; path: where they come from."""
    fresh = network.state_dict()
    refuse_larger(path, {key: value for key, value in stored.items() if not key.endswith(".0.bias")},
                  fresh)
    before = {key: value for key, value in stored.items() if key in fresh}
    for name, _, norm in blocks_of(network):
        bias = stored.get(f"{name}.0.bias")
        if bias is None:  # a block that was added
            continue
        before[f"{name}.1.bias"] = bias
        before[f"{name}.1.weight"] = torch.ones_like(bias)
        before[f"{name}.1.running_mean"] = torch.zeros_like(bias)
        before[f"{name}.1.running_var"] = torch.full_like(bias, 1.0 - norm.eps)
    return grown(before, fresh)


def settle(network, batches):
    """Gives every batch norm the mean and spread that its input has over batches, and undoes both in
    its scale and shift: the network computes what it did, and goes on doing so in training, where
    batch norms take means and spreads from the batch."""
    sums = {}

    def measure(norm, inputs):
        x = inputs[0].double()
        total = sums.setdefault(norm, [0, 0.0, 0.0])
        total[0] += x.numel() // x.shape[1]
        total[1] = total[1] + x.sum((0, 2, 3))
        total[2] = total[2] + (x * x).sum((0, 2, 3))

    hooks = [norm.register_forward_pre_hook(measure) for _, _, norm in blocks_of(network)]
    network.eval()
    with torch.no_grad():
        for batch in batches:
            network(batch)
        for hook in hooks:
            hook.remove()
        for norm, (count, total, squares) in sums.items():
            mean = total / count
            spread = (squares / count - mean * mean).clamp(min=1e-8).float()
            mean = mean.float()
            scale = norm.weight / (norm.running_var + norm.eps).sqrt()
            norm.bias += scale * (mean - norm.running_mean)
            norm.weight.copy_(scale * (spread + norm.eps).sqrt())
            norm.running_mean.copy_(mean)
            norm.running_var.copy_(spread)
    network.train()
