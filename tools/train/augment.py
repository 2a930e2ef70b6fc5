# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""Changes of a picture's light, colour and quality, so that networks that only ever saw rendered
garages work on real pictures. Pictures are float32 RGB, 0 to 255, H x W x 3."""
import io

import numpy as np
from PIL import Image
from scipy import ndimage


def smooth_field(rng, shape, cells):
    """Smooth random values, mean 0, deviation about 1."""
    coarse = rng.normal(size=(cells + 3, cells + 3)).astype(np.float32)
    return np.asarray(Image.fromarray(coarse).resize(shape[::-1], Image.BICUBIC))


def floor_texture(rng, shape):
    """A pattern that multiplies the floor: paving stones, stripes, or grains of some size."""
    kind = rng.integers(4)
    v, u = np.mgrid[0 : shape[0], 0 : shape[1]].astype(np.float32)
    if kind == 0:  # stones with joints
        angle = rng.uniform(0, np.pi)
        a = u * np.cos(angle) + v * np.sin(angle) + rng.uniform(0, 99)
        b = v * np.cos(angle) - u * np.sin(angle) + rng.uniform(0, 99)
        length, width = rng.uniform(4, 30), rng.uniform(3, 15)
        row = np.floor(b / width)
        joint = ((a + 0.5 * length * (row % 2)) % length < 1.0) | (b % width < 1.0)
        tone = rng.normal(0, 0.08, 4096).astype(np.float32)
        stone = (np.floor((a + 0.5 * length * (row % 2)) / length) * 57 + row * 131).astype(int)
        return 1.0 + tone[stone % 4096] - joint * rng.uniform(-0.15, 0.3)
    if kind == 1:  # stripes: tyre marks, brushed concrete
        angle = rng.uniform(0, np.pi)
        a = u * np.cos(angle) + v * np.sin(angle)
        return 1.0 + rng.uniform(0.03, 0.12) * np.sin(a * rng.uniform(0.05, 1.0) + rng.uniform(0, 6))
    if kind == 2:  # patches
        return 1.0 + rng.uniform(0.05, 0.25) * smooth_field(rng, shape, int(rng.integers(3, 40)))
    grain = ndimage.gaussian_filter(rng.normal(size=shape).astype(np.float32), rng.uniform(0.4, 2.0))
    return 1.0 + rng.uniform(0.03, 0.2) * grain / max(grain.std(), 1e-6)


def shadow(rng, shape):
    """Sunlight past edges: half planes and bands, darker or brighter."""
    v, u = np.mgrid[0 : shape[0], 0 : shape[1]].astype(np.float32)
    angle = rng.uniform(0, 2 * np.pi)
    a = (u - rng.uniform(0, shape[1])) * np.cos(angle) + (v - rng.uniform(0, shape[0])) * np.sin(angle)
    soft = rng.uniform(0.5, 6.0)
    inside = 1.0 / (1.0 + np.exp(np.clip(-a / soft, -30, 30)))
    if rng.random() < 0.5:
        inside *= 1.0 / (1.0 + np.exp(np.clip((a - rng.uniform(15, 150)) / soft, -30, 30)))
    return 1.0 + inside * (rng.uniform(0.35, 0.9) - 1.0)


def glare(rng, image):
    height, width = image.shape[:2]
    v, u = np.mgrid[0:height, 0:width].astype(np.float32)
    for _ in range(rng.integers(1, 4)):
        angle, long, short = rng.uniform(0, np.pi), rng.uniform(10, 90), rng.uniform(4, 30)
        du, dv = u - rng.uniform(0, width), v - rng.uniform(0, height)
        a = (du * np.cos(angle) + dv * np.sin(angle)) / long
        b = (dv * np.cos(angle) - du * np.sin(angle)) / short
        blob = np.exp(-0.5 * np.minimum(a * a + b * b, 50.0))
        image = image + blob[..., None] * rng.uniform(20, 160) * rng.uniform(0.8, 1.0, 3)
    return image


def recode(rng, image):
    stream = io.BytesIO()
    Image.fromarray(np.clip(image, 0, 255).astype(np.uint8)).save(
        stream, "JPEG", quality=int(rng.integers(30, 95)))
    return np.asarray(Image.open(stream)).astype(np.float32)


def coarser(rng, image):
    """Fewer pixels, as a lower resolution or a flatter view gives, in one direction or both."""
    fx, fy = np.exp(rng.uniform(0, np.log(2.2), 2)) if rng.random() < 0.5 else \
        [np.exp(rng.uniform(0, np.log(2.2)))] * 2
    height, width = image.shape[:2]
    small = Image.fromarray(np.clip(image, 0, 255).astype(np.uint8)).resize(
        (max(8, int(width / fx)), max(8, int(height / fy))), Image.BILINEAR)
    return np.asarray(small.resize((width, height), Image.BICUBIC)).astype(np.float32)


# What white paint becomes: blue and red of reserved slots, green of charging places, yellow.
PAINTS = np.array([[0.20, 0.40, 0.85], [0.85, 0.25, 0.22], [0.25, 0.70, 0.40], [1.0, 0.75, 0.15]],
                  np.float32)


def repaint(rng, image, labels, floor, lines):
    """The lines of some places in another colour, and of some faded towards the floor around them.
    floor, lines: labels."""
    shape = labels.shape
    bare = (labels == floor).astype(np.float32)[..., None]
    around = ndimage.gaussian_filter(image * bare, (4, 4, 0))
    around = around / np.maximum(ndimage.gaussian_filter(bare, (4, 4, 0)), 1e-3)
    mask = ndimage.gaussian_filter((labels == lines).astype(np.float32), 0.5)[..., None]
    there = (smooth_field(rng, shape, 2) > rng.normal(-0.5, 0.7))[..., None]
    paint = image
    if rng.random() < 0.7:
        grey = image.mean(2, keepdims=True)  # yellow lines too
        tint = PAINTS[rng.choice(len(PAINTS), p=[0.55, 0.15, 0.15, 0.15])] ** rng.uniform(0.5, 1.0)
        paint = grey * tint * np.exp(rng.normal(0, 0.15, 3)).astype(np.float32) * rng.uniform(0.7, 1.2)
    if rng.random() < 0.6:
        paint = around + rng.uniform(0.35, 1.0) * (paint - around)
    changed = there & (mask > 0.5)
    contrast = np.abs(paint - around).max(2, keepdims=True)
    if not changed.any() or np.median(contrast[changed]) < 10.0:  # nobody would see these lines
        return image
    return np.where(there, image * (1 - mask) + paint * mask, image)


def augment(rng, image, labels, floor_channel=None, line_channel=None, plain=0.3):
    """floor_channel: the label of bare floor, whose colour and texture may change alone;
    line_channel: that of slot lines, whose paint may; plain: the share of pictures that stay nearly as
    they were drawn."""
    image = image.astype(np.float32)
    shape = labels.shape
    black = image.sum(2, keepdims=True) < 1.0
    if line_channel is not None and rng.random() < 0.64 * (1.0 - plain):
        image = repaint(rng, image, labels, floor_channel, line_channel)
    if rng.random() < plain:
        image = image * np.exp(rng.normal(0, 0.15)) + rng.normal(0, 2, shape + (1,))
        return np.where(black, 0, np.clip(image, 0, 255)).astype(np.uint8)
    if floor_channel is not None and rng.random() < 0.4:
        mask = ndimage.gaussian_filter((labels == floor_channel).astype(np.float32), 0.5)[..., None]
        tint = np.exp(rng.normal(0, 0.15) + rng.normal(0, 0.06, 3)).astype(np.float32)
        floor = image * tint * floor_texture(rng, shape)[..., None]
        image = image * (1 - mask) + floor * mask
    elif rng.random() < 0.15:
        image = image * floor_texture(rng, shape)[..., None]
    if rng.random() < 0.25:
        image = image * shadow(rng, shape)[..., None]
    if rng.random() < 0.3:
        image = image * np.exp(0.2 * smooth_field(rng, shape, int(rng.integers(1, 4))))[..., None]
    if rng.random() < 0.3:
        image = glare(rng, image)
    if rng.random() < 0.7:
        image = image * np.exp(rng.normal(0, 0.3) + rng.normal(0, 0.06, 3)).astype(np.float32)
    if rng.random() < 0.2:  # less colour, or none
        grey = image.mean(2, keepdims=True)
        image = grey + rng.uniform(0.0, 0.8) * (image - grey)
    if rng.random() < 0.5:
        gamma = np.exp(rng.normal(0, 0.22))
        image = 255.0 * (np.clip(image, 0, 255) / 255.0) ** gamma
    if rng.random() < 0.4:
        middle = image.mean()
        image = middle + (image - middle) * np.exp(rng.normal(0, 0.25)) + rng.normal(0, 10)
    if rng.random() < 0.25:
        image = coarser(rng, image)
    if rng.random() < 0.2:
        image = ndimage.gaussian_filter(image, (*rng.uniform(0.2, 1.2, 2), 0))
    if rng.random() < 0.15:  # sharpened, as cameras do
        image = image + rng.uniform(0.3, 1.2) * (image - ndimage.gaussian_filter(image, (1, 1, 0)))
    if rng.random() < 0.4:
        image = image + rng.normal(0, rng.uniform(1, 12), image.shape).astype(np.float32)
    if rng.random() < 0.15:
        image = recode(rng, image)
    return np.where(black, 0, np.clip(image, 0, 255)).astype(np.uint8)
