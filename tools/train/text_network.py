# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""The reader of zone texts: a small convolutional network over a straightened face, one column of
logits for every second pixel column, decoded as a sequence (connectionist temporal classification,
Graves et al. 2006). Channel 0 is the blank, then the letters of ALPHABET.
"""
import torch
from torch import nn
from torch.nn import functional as F

# Of zones; I and O are left out: garages avoid them since they look like digits.
ZONE_LETTERS = "0123456789ABCDEFGHJKLMNPQRSTUVWXYZ-"
ALPHABET = ZONE_LETTERS + "IO<>^"  # and of guide signs, with arrows
WIDTH, HEIGHT = 96, 40
MEAN, SCALE = 128.0, 1.0 / 40.0


def block(channels_in, channels_out, kernel=3, dilation=1, padding=None):
    size = (kernel, kernel) if isinstance(kernel, int) else kernel
    if padding is None:
        padding = tuple(d * (k - 1) // 2 for k, d in zip(size, (1, dilation)))
    return nn.Sequential(
        nn.Conv2d(channels_in, channels_out, size, 1, padding, (1, dilation), bias=False),
        nn.BatchNorm2d(channels_out), nn.ReLU(inplace=True))


# Channels of the convolutions, in their order.
WIDTHS = {"text": (16, 32, 48, 48, 64, 80), "text-wide": (24, 48, 80, 80, 112, 128)}


class TextNetwork(nn.Module):
    def __init__(self, name="text"):
        super().__init__()
        a, b, c, d, e, f = WIDTHS[name]
        self.layers = nn.Sequential(
            block(3, a), nn.MaxPool2d(2),                          # 20 x 48
            block(a, b), nn.MaxPool2d((2, 1)),                     # 10 x 48
            block(b, c), block(c, d), nn.MaxPool2d((2, 1)),        # 5 x 48
            block(d, e),
            block(e, f, (5, 3), padding=(0, 1)),                   # 1 x 48
            block(f, f, (1, 5), dilation=2),                       # a second copy beside the first
            block(f, f, (1, 5), dilation=4),
            nn.Conv2d(f, len(ALPHABET) + 1, 1))

    def forward(self, x):
        """N x 3 x 40 x 96 (RGB, normalised) -> logits N x channels x 1 x 48."""
        return self.layers(x)


def name_of(state):
    """Of the network whose weights a state of train_text.py or an exported file holds."""
    first = state["layers.0.0.weight"].shape[0]
    return next(name for name, widths in WIDTHS.items() if widths[0] == first)


def to_input(patches):
    """N x 40 x 96 x 3 bytes, RGB -> the network's input."""
    return (torch.from_numpy(patches).permute(0, 3, 1, 2).float() - MEAN) * SCALE


def encode(text):
    return [ALPHABET.index(letter) + 1 for letter in text]


def read(logits):
    """The most probable path of each, as texts."""
    texts = []
    for path in logits[:, :, 0].argmax(1).tolist():
        text, last = "", 0
        for symbol in path:
            if symbol != last and symbol > 0:
                text += ALPHABET[symbol - 1]
            last = symbol
        texts.append(text)
    return texts


def column_loss(logits, texts, middles):
    """Cross entropy by column, for faces whose letters' places are known: the letter at its middle,
    blank from there to the next but for the columns beside the middle, which may say either."""
    steps = logits.shape[-1]
    targets = torch.zeros(len(texts), steps, dtype=torch.long)
    for row, text, columns in zip(targets, texts, middles):
        at = [int(round(0.5 * x - 0.5)) for x in columns]
        for k in at:
            for near in (k - 1, k + 1):
                if 0 <= near < steps:
                    row[near] = -100
        for k, symbol in zip(at, encode(text)):
            if 0 <= k < steps:
                row[k] = symbol
    return F.cross_entropy(logits[:, :, 0], targets, ignore_index=-100, reduction="sum") / len(texts)


def sequence_loss(logits, texts):
    log_p = F.log_softmax(logits[:, :, 0], 1).permute(2, 0, 1)
    targets = torch.tensor([symbol for text in texts for symbol in encode(text)])
    lengths = torch.tensor([len(text) for text in texts])
    steps = torch.full((len(texts),), log_p.shape[0])
    return F.ctc_loss(log_p, targets, steps, lengths, reduction="sum",
                      zero_infinity=True) / len(texts)
