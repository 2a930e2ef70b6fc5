# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""A plain U-Net whose parts OpenCV 4.6 runs fast: 3x3 convolutions, bilinear resizing, sums.

The logits have half the picture's resolution and four values per class, one for each pixel of a
2 x 2 block (order: class, row, column, as PixelShuffle has it). Lines three pixels wide keep their
edges that way, at the price of a half-size network. The export leaves the shuffle to the program,
since OpenCV's permutation of it takes longer than the whole rest.
"""
import torch
from torch import nn
from torch.nn import functional as F

WIDTHS = {"bev": [16, 32, 64, 96, 128], "raw": [16, 24, 48, 64, 96]}


class ConvBlock(nn.Sequential):
    def __init__(self, channels_in, channels_out, stride=1):
        super().__init__(
            nn.Conv2d(channels_in, channels_out, 3, stride, 1, bias=False),
            nn.BatchNorm2d(channels_out),
            nn.ReLU(inplace=True),
        )


class UNet(nn.Module):
    def __init__(self, num_classes, widths):
        super().__init__()
        self.stem = ConvBlock(3, widths[0], 2)
        self.down = nn.ModuleList([ConvBlock(widths[0], widths[0])])
        for before, after in zip(widths[:-1], widths[1:]):
            self.down.append(nn.Sequential(ConvBlock(before, after, 2), ConvBlock(after, after)))
        pairs = list(zip(widths[:-1], widths[1:]))[::-1]
        self.narrow = nn.ModuleList([nn.Conv2d(low, high, 1) for high, low in pairs])
        self.up = nn.ModuleList([ConvBlock(high, high) for high, _ in pairs])
        # Four pixels' classes need more than the narrow features of the finest level.
        self.up[-1] = ConvBlock(widths[0], 2 * widths[0])
        self.head = nn.Conv2d(2 * widths[0], 4 * num_classes, 1)

    def forward(self, x):
        """Logits of half size, 4 x classes channels."""
        x = self.stem(x)
        levels = []
        for block in self.down:
            x = block(x)
            levels.append(x)
        for narrow, up, skip in zip(self.narrow, self.up, levels[-2::-1]):
            x = F.interpolate(narrow(x), scale_factor=2.0, mode="bilinear", align_corners=False)
            x = up(x + skip)
        return self.head(x)


def make_network(name, num_classes):
    return UNet(num_classes, WIDTHS[name])


def grown(before, now):
    """The state dict `now` of a fresh network with the weights of a narrower or equal one in it. What
    the old channels compute stays as it was: new ones feed nothing into them until training says so."""
    state = {}
    for key, fresh in now.items():
        old = before.get(key)
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
