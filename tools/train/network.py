# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""A plain U-Net whose parts OpenCV 4.6 runs fast: 3x3 convolutions, bilinear resizing, sums.

The logits have half the labels' resolution and four values per class, one for each pixel of a
2 x 2 block (order: class, row, column, as PixelShuffle has it). Lines three pixels wide keep their
edges that way, at the price of a half-size network. The export leaves the shuffle to the program,
since OpenCV's permutation of it takes longer than the whole rest.
"""
import torch
from torch import nn
from torch.nn import functional as F

# What each network labels (NETWORKS in classes.py).
PICTURES = {"bev": "bev", "bev-deep": "bev", "raw": "raw", "raw-deep": "raw"}
WIDTHS = {"bev": [16, 32, 64, 96, 128], "bev-deep": [16, 32, 64, 96, 128],
          "raw": [16, 24, 48, 64, 96], "raw-deep": [16, 32, 48, 64, 96]}
# Channels, kernel and stride of the first convolution. One of 6 and 4 sees twice the pixels that are labelled
# (PX_PER_LABEL and size in classes.py), and begins as one of 3 and 2 for their means.
STEMS = {"bev": (16, 3, 2), "raw": (16, 3, 2)}
# Residual blocks behind each level. Where pictures are small they cost little and see far: what is worn or
# in glare is told by what stands around.
DEPTHS = {"bev": [0, 0, 0, 0, 0], "bev-deep": [1, 1, 1, 2, 1], "raw": [0, 0, 0, 0, 0],
          "raw-deep": [1, 1, 1, 2, 2]}


class ConvBlock(nn.Sequential):
    def __init__(self, channels_in, channels_out, stride=1, kernel=3):
        padding = (kernel - 1) // 2
        super().__init__(
            nn.Conv2d(channels_in, channels_out, kernel, stride, padding, bias=False),
            nn.BatchNorm2d(channels_out),
            nn.ReLU(inplace=True),
        )


class Residual(nn.Module):
    """Begins as the identity, so that a trained network may be given more of them."""

    def __init__(self, channels):
        super().__init__()
        self.block = ConvBlock(channels, channels)
        self.last = nn.Conv2d(channels, channels, 3, 1, 1)
        nn.init.zeros_(self.last.weight)
        nn.init.zeros_(self.last.bias)

    def forward(self, x):
        return F.relu(x + self.last(self.block(x)))


class UNet(nn.Module):
    def __init__(self, num_classes, stem, widths, depths):
        super().__init__()
        channels, kernel, stride = stem
        self.stem = ConvBlock(3, channels, stride, kernel)
        self.down = nn.ModuleList([ConvBlock(channels, widths[0])])
        for before, after in zip(widths[:-1], widths[1:]):
            self.down.append(nn.Sequential(ConvBlock(before, after, 2), ConvBlock(after, after)))
        self.deep = nn.ModuleList([nn.Sequential(*(Residual(width) for _ in range(depth)))
                                   for width, depth in zip(widths, depths)])
        pairs = list(zip(widths[:-1], widths[1:]))[::-1]
        self.narrow = nn.ModuleList([nn.Conv2d(low, high, 1) for high, low in pairs])
        self.up = nn.ModuleList([ConvBlock(high, high) for high, _ in pairs])
        # Four pixels' classes need more than the narrow features of the finest level.
        self.up[-1] = ConvBlock(widths[0], 2 * widths[0])
        self.head = nn.Conv2d(2 * widths[0], 4 * num_classes, 1)

    def forward(self, x):
        """Logits of half the size of the labels, 4 x classes channels."""
        x = self.stem(x)
        levels = []
        for block, deep in zip(self.down, self.deep):
            x = deep(block(x))
            levels.append(x)
        for narrow, up, skip in zip(self.narrow, self.up, levels[-2::-1]):
            x = F.interpolate(narrow(x), scale_factor=2.0, mode="bilinear", align_corners=False)
            x = up(x + skip)
        return self.head(x)


def make_network(name, num_classes):
    pictures = PICTURES[name]
    return UNet(num_classes, STEMS[pictures], WIDTHS[name], DEPTHS[name])


def name_of(state):
    """Of the network that a state file of train.py holds. Before there were two for stitched pictures,
    the one with residual blocks was called bev as well."""
    deep = any(key.startswith("deep.") for key in state["average"])
    return state["name"] + "-deep" if deep and not state["name"].endswith("-deep") else state["name"]


def network_of(weights):
    """(name, number of classes) of the network whose weights by name these are, batch norms folded or not."""
    kernels = lambda state: {k: v.shape for k, v in state.items() if v.dim() == 4}  # noqa: E731
    classes = weights["head.weight"].shape[0] // 4
    for name in PICTURES:
        if kernels(make_network(name, classes).state_dict()) == kernels(weights):
            return name, classes
    raise SystemExit(f"weights of none of {', '.join(PICTURES)}")


def grown(before, now):
    """The state dict `now` of a fresh network with the weights of a narrower, shallower or equal one in it.
    What the old channels compute stays as it was: new ones feed nothing into them until training says so.
    A kernel of twice the size is the old one for a picture of twice the pixels."""
    state = {}
    for key, fresh in now.items():
        old = before.get(key)
        if old is not None and old.dim() == 4 and fresh.shape[2] == 2 * old.shape[2] > 2:
            old = 0.25 * old.repeat_interleave(2, 2).repeat_interleave(2, 3)
        if old is None or any(a > b for a, b in zip(old.shape, fresh.shape)):
            state[key] = fresh
            continue
        value = fresh.clone()
        if value.dim() == 4:
            value[: old.shape[0]] = 0.0
        value[tuple(slice(0, n) for n in old.shape)] = old
        state[key] = value
    return state


def full_size(logits):
    return F.pixel_shuffle(logits, 2)


def fold_batch_norm(network):
    """Puts every batch norm into the convolution before it; the network must be in eval mode."""
    for module in network.modules():
        if isinstance(module, ConvBlock):
            module[0] = torch.nn.utils.fusion.fuse_conv_bn_eval(module[0], module[1])
            module[1] = nn.Identity()
            module[2] = nn.ReLU()
    return network


# Input normalisation: (value - MEAN) * SCALE, of RGB from 0 to 255.
MEAN = 110.0
SCALE = 1.0 / 60.0


def to_input(images):
    """uint8 RGB, N x H x W x 3 -> float N x 3 x H x W."""
    x = torch.as_tensor(images).permute(0, 3, 1, 2).float()
    return ((x - MEAN) * SCALE).contiguous(memory_format=torch.channels_last)
