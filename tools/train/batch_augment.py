# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
"""What augment.py does to one picture, and more, for a batch of them on any device. Pictures are float RGB,
0 to 255, N x 3 x H x W; every picture draws its own numbers."""
import math

import torch
from torch.nn import functional as F

from augment import PAINTS


class Draw:
    """Random numbers, one for each picture of a batch, that multiply N x C x H x W."""

    def __init__(self, batch, device):
        self.shape, self.device = (batch, 1, 1, 1), device

    def uniform(self, low, high, channels=1):
        shape = (self.shape[0], channels, 1, 1)
        return low + (high - low) * torch.rand(shape, device=self.device)

    def normal(self, mean, deviation, channels=1):
        shape = (self.shape[0], channels, 1, 1)
        return mean + deviation * torch.randn(shape, device=self.device)

    def chance(self, share):
        return torch.rand(self.shape, device=self.device) < share


def smooth_field(batch, size, cells, device):
    """Smooth random values, mean 0, deviation about 1, N x 1 x H x W."""
    coarse = torch.randn(batch, 1, cells + 3, cells + 3, device=device)
    return F.interpolate(coarse, size=size, mode="bicubic", align_corners=False)


def coordinates(size, device):
    v = torch.arange(size[0], device=device, dtype=torch.float32)[None, None, :, None]
    u = torch.arange(size[1], device=device, dtype=torch.float32)[None, None, None, :]
    return u, v


def rotated(draw, size, full_turn):
    angle = draw.uniform(0, full_turn)
    u, v = coordinates(size, draw.device)
    return u * angle.cos() + v * angle.sin(), v * angle.cos() - u * angle.sin()


def about(draw, along, reach):
    """A coordinate from somewhere within reach of the picture's middle on."""
    return along - along.mean((2, 3), keepdim=True) + draw.uniform(-reach, reach)


def floor_texture(draw, size):
    """A pattern that multiplies the floor: paving stones, stripes, patches or grains."""
    batch, device = draw.shape[0], draw.device
    a, b = rotated(draw, size, math.pi)
    a, b = a + draw.uniform(0, 99), b + draw.uniform(0, 99)
    length, width = draw.uniform(4, 30), draw.uniform(3, 15)
    row = torch.floor(b / width)
    along = a + 0.5 * length * (row % 2)
    joint = ((along % length < 1.0) | (b % width < 1.0)).float()
    tone = 0.08 * torch.randn(4096, device=device)
    stone = (torch.floor(along / length) * 57 + row * 131).long() % 4096
    stones = 1.0 + tone[stone] - joint * draw.uniform(-0.15, 0.3)
    stripes = 1.0 + draw.uniform(0.03, 0.12) * torch.sin(
        a * draw.uniform(0.05, 1.0) + draw.uniform(0, 6))
    cells = int(torch.randint(3, 40, (1,)))
    patches = 1.0 + draw.uniform(0.05, 0.25) * smooth_field(batch, size, cells, device)
    grain = blurred(torch.randn(batch, 1, *size, device=device), draw.uniform(0.4, 2.0))
    grain = 1.0 + draw.uniform(0.03, 0.2) * grain / grain.std((2, 3), keepdim=True).clamp(min=1e-6)
    kind = torch.randint(4, draw.shape, device=device)
    return torch.where(kind == 0, stones, torch.where(kind == 1, stripes,
                                                      torch.where(kind == 2, patches, grain)))


def shadow(draw, size):
    """Sunlight past edges: half planes and bands, darker or brighter."""
    a, _ = rotated(draw, size, 2 * math.pi)
    a = about(draw, a, 120)
    soft = draw.uniform(0.3, 6)
    inside = torch.sigmoid(a / soft)
    band = torch.sigmoid(-(a - draw.uniform(15, 150)) / soft)
    inside = torch.where(draw.chance(0.5), inside * band, inside)
    return 1.0 + inside * (draw.uniform(0.35, 0.9) - 1.0)


def cameras(draw, images):
    """As cameras that expose and balance colours each for itself, stitched with seams: pictures before, behind and
    beside the car part along rays from its corners. Some overexpose."""
    u, v = coordinates(images.shape[2:], draw.device)
    x = about(draw, u, 40)
    y = about(draw, v, 40)
    beside = (x.abs() - draw.uniform(15, 35)) * draw.uniform(0.4, 1.6)
    soft = draw.uniform(0.2, 8)
    ends = torch.sigmoid((y.abs() - draw.uniform(40, 75) - beside.clamp(min=0)) / soft)
    ahead, right = torch.sigmoid(-y / soft), torch.sigmoid(x / soft)
    parts = [ends * ahead, ends * (1 - ahead), (1 - ends) * right, (1 - ends) * (1 - right)]
    strength = draw.uniform(0.1, 0.4)
    gain = lambda: torch.exp(strength * draw.normal(0, 1) + draw.normal(0, 0.05, 3)) * torch.where(  # noqa: E731
        draw.chance(0.06), draw.uniform(1.5, 4.0), 1.0)
    return sum(part * (images * gain() + 20 * strength * draw.normal(0, 1)) for part in parts)


def shade(draw, images):
    """Sunlight through trees and past cars: shadows of any outline, bluer than what lies in the sun, and the own car's."""
    size = images.shape[2:]
    field = smooth_field(len(images), size, int(torch.randint(1, 16, (1,))), draw.device)
    inside = torch.sigmoid((field - draw.normal(0.3, 0.6)) / draw.uniform(0.01, 0.3))
    a, b = rotated(draw, size, math.pi)
    a = about(draw, a, 60).abs() - draw.uniform(20, 70)
    b = about(draw, b, 60).abs() - draw.uniform(15, 60)
    box = torch.sigmoid(-torch.maximum(a, b) / draw.uniform(0.5, 4))
    inside = torch.where(draw.chance(0.3), box, inside)
    dark = draw.uniform(0.25, 0.85) * torch.exp(draw.normal(0, 0.04, 3))
    return images * (1.0 + inside * (dark - 1.0))


def plates(draw, images, labels, floor):
    """Covers, drains and slabs that lie in the floor, framed and barred or not."""
    size = images.shape[2:]
    bare = (labels == floor)[:, None]
    for k in range(3):
        a, b = rotated(draw, size, math.pi)
        a = about(draw, a, 170)
        b = about(draw, b, 170)
        half = draw.uniform(5, 28)
        edge = torch.maximum(a.abs() - half, b.abs() - half * draw.uniform(0.5, 1.6))
        frame = (edge.abs() < draw.uniform(0.4, 1.4)) & draw.chance(0.7)
        bar = draw.uniform(4, 9)
        barred = ((a % bar < 1.3) | ((b % bar < 1.3) & draw.chance(0.6))) & (edge < 0) & draw.chance(0.4)
        inside = (edge < 0) & bare & draw.chance(1.0 - k / 3.0)
        tone = torch.where(frame | barred, draw.uniform(0.4, 1.5), draw.uniform(0.75, 1.25))
        images = torch.where(inside | (frame & bare & draw.chance(1.0 - k / 3.0)), images * tone, images)
    return images


def glare(draw, images):
    size = images.shape[2:]
    for k in range(3):
        a, b = rotated(draw, size, math.pi)
        a = about(draw, a, 190) / draw.uniform(10, 90)
        b = about(draw, b, 190) / draw.uniform(4, 30)
        blob = torch.exp(-0.5 * (a * a + b * b).clamp(max=50.0))
        strength = draw.uniform(20, 160) * draw.uniform(0.8, 1.0, 3)
        images = images + blob * strength * (draw.chance(1.0 - k / 3.0))
    return images


def blurred(images, sigma_v, sigma_u=None, reach=4):
    """Gaussian, each picture by its own deviations (px) along rows and columns."""
    for dim, sigma in ((2, sigma_v), (3, sigma_v if sigma_u is None else sigma_u)):
        steps = torch.arange(-reach, reach + 1, device=images.device, dtype=torch.float32)
        kernel = torch.exp(-0.5 * (steps / sigma.reshape(-1, 1).clamp(min=1e-3)) ** 2)
        kernel = kernel / kernel.sum(1, keepdim=True)
        pad = (0, 0, reach, reach) if dim == 2 else (reach, reach, 0, 0)
        wide = F.pad(images, pad, mode="replicate")
        length = images.shape[dim]
        images = sum(kernel[:, k].reshape(-1, 1, 1, 1) * wide.narrow(dim, k, length)
                     for k in range(2 * reach + 1))
    return images


def coarser(images, most=2.2):
    """Fewer pixels, as a lower resolution or a flatter view gives; one factor a batch, either way."""
    height, width = images.shape[2:]
    fv, fu = torch.exp(torch.rand(2) * math.log(most)).tolist()
    small = F.interpolate(images, size=(max(6, int(height / fv)), max(8, int(width / fu))),
                          mode="bilinear", align_corners=False)
    return F.interpolate(small, size=(height, width), mode="bicubic", align_corners=False)


def recoded(images, strength):
    """As JPEG leaves pictures: cosines of 8 x 8 blocks rounded, more so the finer they are.
    strength: step of the coarsest, grey levels."""
    n, channels, height, width = images.shape
    k = torch.arange(8, device=images.device, dtype=torch.float32)
    basis = 0.5 * torch.cos((2 * k[None] + 1) * k[:, None] * math.pi / 16)
    basis[0] *= math.sqrt(0.5)
    step = strength[..., None, None] * (1.0 + 0.6 * (k[:, None] + k[None]))
    blocks = images.reshape(n, channels, height // 8, 8, width // 8, 8).permute(0, 1, 2, 4, 3, 5)
    found = basis @ blocks @ basis.T
    found = torch.round(found / step) * step
    blocks = basis.T @ found @ basis
    return blocks.permute(0, 1, 2, 4, 3, 5).reshape(n, channels, height, width)


def repaint(draw, images, labels, floor, lines):
    """The lines of some places in another colour, and of some faded towards the floor around them."""
    bare = (labels == floor).float()[:, None]
    soft = torch.full(draw.shape, 4.0, device=draw.device)
    around = blurred(images * bare, soft, reach=8) / blurred(bare, soft, reach=8).clamp(min=1e-3)
    mask = blurred((labels == lines).float()[:, None], 0.125 * soft, reach=2)
    there = smooth_field(len(images), images.shape[2:], 2, draw.device) > draw.normal(-0.5, 0.7)
    shares = torch.tensor([0.55, 0.15, 0.15, 0.15])
    chosen = torch.multinomial(shares, len(images), replacement=True)
    colours = torch.tensor(PAINTS)[chosen].to(draw.device, non_blocking=True)
    tint = colours[:, :, None, None] ** draw.uniform(0.5, 1.0)
    grey = images.mean(1, keepdim=True)
    tinted = grey * tint * torch.exp(draw.normal(0, 0.15, 3)) * draw.uniform(0.7, 1.2)
    paint = torch.where(draw.chance(0.7), tinted, images)
    paint = torch.where(draw.chance(0.6), around + draw.uniform(0.35, 1.0) * (paint - around), paint)
    changed = (there & (mask > 0.5)).float()
    contrast = ((paint - around).abs().amax(1, keepdim=True) * changed).sum((2, 3), keepdim=True)
    contrast = contrast / changed.sum((2, 3), keepdim=True).clamp(min=1.0)
    visible = there & (contrast > 10.0)  # nobody would see these lines
    return torch.where(visible, images * (1 - mask) + paint * mask, images)


def on_some(share, change, images, *others):
    """change(images, *others) for that share of the pictures; the others stay."""
    chosen = (torch.rand(len(images)) < share).nonzero()[:, 0]  # not on the device, which would be waited for
    if len(chosen) == 0:
        return images
    chosen = chosen.to(images.device, non_blocking=True)
    part = change(Draw(len(chosen), images.device), images[chosen], *(one[chosen] for one in others))
    return images.index_copy(0, chosen, part)


def new_floor(draw, images, labels, floor):
    half = torch.full(draw.shape, 0.5, device=draw.device)
    mask = blurred((labels == floor).float()[:, None], half, reach=2)
    tint = torch.exp(draw.normal(0, 0.15) + draw.normal(0, 0.06, 3))
    return images * (1 - mask) + images * tint * floor_texture(draw, images.shape[2:]) * mask


def new_tones(draw, images):
    images = torch.where(draw.chance(0.7), images * torch.exp(
        draw.normal(0, 0.3) + draw.normal(0, 0.06, 3)), images)
    grey = images.mean(1, keepdim=True)
    images = torch.where(draw.chance(0.2), grey + draw.uniform(0, 0.8) * (images - grey), images)
    gamma = torch.where(draw.chance(0.5), torch.exp(draw.normal(0, 0.22)), 1.0)
    images = 255.0 * (images.clamp(0.01, 255) / 255.0) ** gamma
    middle = images.mean((1, 2, 3), keepdim=True)
    return torch.where(draw.chance(0.4), middle + (images - middle) * torch.exp(
        draw.normal(0, 0.25)) + draw.normal(0, 10), images)


def sharpened(draw, images):
    return images + draw.uniform(0.3, 1.2) * (images - blurred(images, draw.uniform(0.9, 1.1), reach=3))


def changed(draw, images, labels, floor):
    size = images.shape[2:]
    if floor is not None:
        images = on_some(0.4, lambda d, x, y: new_floor(d, x, y, floor), images, labels)
    images = on_some(0.09, lambda d, x: x * floor_texture(d, size), images)
    if floor is not None:
        images = on_some(0.3, lambda d, x, y: plates(d, x, y, floor), images, labels)
    images = on_some(0.25, lambda d, x: x * shadow(d, size), images)
    if floor is not None:
        images = on_some(0.3, shade, images)
    field = smooth_field(len(images), size, int(torch.randint(1, 4, (1,))), images.device)
    images = images * torch.exp(torch.where(draw.chance(0.3), 0.2 * field, 0.0))
    images = on_some(0.4, glare, images)
    if floor is not None:
        images = on_some(0.35, cameras, images)
    images = new_tones(draw, images)
    images = on_some(0.25, lambda d, x: coarser(x), images)
    images = on_some(0.25, lambda d, x: blurred(x, d.uniform(0.2, 1.2), d.uniform(0.2, 1.2), reach=3),
                     images)
    images = on_some(0.15, sharpened, images)
    images = on_some(0.4, lambda d, x: x + torch.randn_like(x) * d.uniform(1, 12), images)
    return on_some(0.15, lambda d, x: recoded(x, d.uniform(1.0, 12.0)), images)


def augment(images, labels, floor=None, lines=None, plain=0.3):
    """floor: the label of bare floor, whose colour and texture may change alone; lines: that of slot
    lines, whose paint may; plain: the share of pictures that stay nearly as they were drawn."""
    black = images.sum(1, keepdim=True) < 1.0
    if lines is not None:
        images = on_some(0.64 * (1.0 - plain),
                         lambda d, x, y: repaint(d, x, y, floor, lines), images, labels)
    draw = Draw(len(images), images.device)
    kept = images * torch.exp(draw.normal(0, 0.15)) + 2.0 * torch.randn(
        len(images), 1, *images.shape[2:], device=images.device)
    images = on_some(1.0 - plain, lambda d, new, old, y: changed(d, old, y, floor), kept, images, labels)
    return torch.where(black, 0.0, images.clamp(0, 255)).round()


def transform(images, labels, ignore, straight_share, views):
    """Mirrored, moved, turned and scaled pictures with their labels, ignore where nothing is.
    views: of the cameras, which are not turned."""
    n, _, height, width = images.shape
    device = images.device
    r = lambda low, high: low + (high - low) * torch.rand(n, device=device)  # noqa: E731
    if views:
        angle, scale = torch.zeros(n, device=device), r(0.75, 1.15)
        dx, dy = r(-0.12, 0.12) * width, r(-0.1, 0.1) * height
        flip_v = torch.ones(n, device=device)
    else:
        straight = torch.rand(n, device=device) < straight_share
        some = 0.15 * torch.randn(n, device=device)
        angle = torch.where(torch.rand(n, device=device) < 0.5, r(-math.pi, math.pi), some)
        angle = torch.where(straight, 0.0, angle)
        scale = torch.where(straight, 1.0, torch.exp(0.12 * torch.randn(n, device=device)))
        dx, dy = torch.round(r(-0.1, 0.1) * width), torch.round(r(-0.1, 0.1) * height)
        flip_v = torch.where(torch.rand(n, device=device) < 0.5, -1.0, 1.0)
    flip_u = torch.where(torch.rand(n, device=device) < 0.5, -1.0, 1.0)
    c, s = torch.cos(angle) / scale, torch.sin(angle) / scale
    # In grid_sample's coordinates, -1 to 1 along either side.
    ratio = height / width
    theta = torch.stack([
        torch.stack([c * flip_u, -s * flip_v * ratio, 2 * dx / width], 1),
        torch.stack([s * flip_u / ratio, c * flip_v, 2 * dy / height], 1)], 1)
    grid = F.affine_grid(theta, [n, 1, height, width], align_corners=False)
    moved = F.grid_sample(images, grid, mode="bilinear", align_corners=False)
    told = F.grid_sample(labels[:, None].float() + 1.0, grid, mode="nearest", align_corners=False)
    told = told[:, 0].round().long() - 1
    return moved, torch.where(told < 0, ignore, told)
