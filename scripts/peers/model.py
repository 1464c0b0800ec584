"""The depth completion network of models/ in Python, for experiments and for comparison with other tools.

The same tensors go in and come out as in C++, the parameters have the same names, and tests/models/model_py_test.py
holds the two equal. Needs torch and yaml (Debian: python3-torch, run by /usr/bin/python3).

    from model import load_network
    net, config = load_network("runs/demo/best.pt")            # eval mode
    depth_m = net(left, sparse_m)                              # [B,3,H,W], [B,1,H,W] -> [B,1,H,W]
    depth_m = net(left, sparse_m, right, prior_m, focal_baseline_px_m)

    net = DepthCompletionNet(Config(depth_input="raw", head="direct"))   # train mode, new weights
"""

import math
from collections import OrderedDict
from dataclasses import dataclass, field, fields
from typing import List

import torch
import torch.nn.functional as F
import yaml
from torch import nn


@dataclass
class Config:
    """models/depth_completion_net.hpp says what the fields mean; the choices are strings here."""

    stem: str = "downsample"
    normalization: str = "batch"
    fusion: str = "concatenate"
    image_widths: List[int] = field(default_factory=lambda: [64, 128, 256, 512])
    depth_widths: List[int] = field(default_factory=lambda: [32, 64, 128, 256])
    decoder_widths: List[int] = field(default_factory=lambda: [128, 96, 64, 32, 16])
    depth_input: str = "filled"
    head: str = "gated"
    prior: str = "constant"
    stereo: bool = False
    detail_width: int = 0
    fill_smoothing: int = 0
    depth_scale_m: float = 20.0
    min_depth_m: float = 0.5
    max_depth_m: float = 150.0
    depth_kind: str = "plane"

    @property
    def image_channels(self):
        return 3 + (6 if self.stereo else 0)

    @property
    def depth_channels(self):
        return {"raw": 1, "masked": 2, "filled": 5}[self.depth_input]


def load_network(path):
    """Reads a checkpoint of alight-train. Returns the network in eval mode and its Config."""
    archive = torch.jit.load(str(path), map_location="cpu")  # what torch::serialize::OutputArchive writes
    values = yaml.safe_load(archive.model_config)
    unknown = set(values) - {f.name for f in fields(Config)}
    if unknown:
        raise ValueError(f"{path}: its architecture is unknown to this program: {sorted(unknown)}")
    config = Config(**values)
    net = DepthCompletionNet(config)
    net.load_state_dict(archive.weights)  # complains about every tensor that is missing or does not fit
    return net.eval(), config


# --- the inputs --------------------------------------------------------------------------------------------------


def altitude_planes(height_m, down_camera, intrinsics_px, height_px, width_px, max_depth_m):
    """Level ground at the reported height: [B], [B,3], [B,4] (fx fy cx cy) -> [B,1,H,W] metres, 0 = unknown."""
    down, k = down_camera.double(), intrinsics_px.double()
    height = height_m.double().view(-1, 1, 1, 1)
    column = lambda x, i: x[:, i].view(-1, 1, 1, 1)
    u = torch.arange(width_px, dtype=torch.float64).view(1, 1, 1, -1)
    v = torch.arange(height_px, dtype=torch.float64).view(1, 1, -1, 1)
    # How far a ray of plane depth 1 goes down.
    fall = (
        column(down, 0) * (u - column(k, 2)) / column(k, 0)
        + column(down, 1) * (v - column(k, 3)) / column(k, 1)
        + column(down, 2)
    )
    depth_m = (height / fall.clamp_min(1e-9)).clamp(1e-3, max_depth_m)
    known = (height > 0) & height.isfinite() & down.isfinite().all(1).view(-1, 1, 1, 1)
    return torch.where(known, depth_m, torch.zeros_like(depth_m)).float()


def fill_pyramid(value, valid, smoothing=0):
    """Holes filled from a pyramid of local means (models/inputs/sparse_fill.hpp). Returns the fill and its coarseness 0..1."""
    levels = [(torch.where(valid > 0, value, torch.zeros_like(value)), valid)]  # weighted value, weight
    while max(levels[-1][1].shape[2:]) > 1:
        levels.append(tuple(F.avg_pool2d(x, 2, 2, 0, ceil_mode=True) for x in levels[-1]))

    def enlarge(coarse, like):
        twice = F.interpolate(coarse, scale_factor=2.0, mode="bilinear", align_corners=False)
        return twice[:, :, : like.shape[2], : like.shape[3]]

    fill, coarseness = torch.zeros_like(levels[-1][1]), torch.ones_like(levels[-1][1])
    for i in reversed(range(len(levels))):
        weighted_value, weight = levels[i]
        if i + 1 < len(levels):
            fill, coarseness = enlarge(fill, weight), enlarge(coarseness, weight)
        known = weight > 0
        mean = weighted_value / weight.clamp_min(1e-12)
        fill = torch.where(known, mean, fill)
        for _ in range(smoothing):
            fill = torch.where(known, mean, F.avg_pool2d(fill, 3, 1, 1, count_include_pad=False))
        own = torch.full_like(coarseness, i / max(len(levels) - 1, 1))
        coarseness = torch.where(known, own, coarseness)
    return fill, coarseness


def box_mean(x, side_px):
    return F.avg_pool2d(x, side_px, 1, side_px // 2, count_include_pad=False)


def horizontal_gradient(x):
    return F.pad(0.5 * (x[..., 2:] - x[..., :-2]), (1, 1))


def warp(right, disparity_px):
    """right(u - disparity, v), and 1 where that lies inside the right image; all [B,1,H,W]."""
    height, width = right.shape[2:]
    u = torch.arange(width, dtype=right.dtype).view(1, 1, -1) - disparity_px.squeeze(1)
    v = torch.arange(height, dtype=right.dtype).view(1, -1, 1).expand_as(u)
    grid = torch.stack([u * (2.0 / (width - 1)) - 1.0, v * (2.0 / (height - 1)) - 1.0], 3)
    image = F.grid_sample(right, grid, mode="bilinear", padding_mode="border", align_corners=True)
    return image, (u >= 0).unsqueeze(1).to(right.dtype)


def cue_at_scale(left, warped, valid, disparity_px):
    a, b = left - box_mean(left, 15), warped - box_mean(warped, 15)
    slope = 0.5 * (horizontal_gradient(a) + horizontal_gradient(b)) * valid
    slope_change = box_mean(slope * (b - a) * valid, 9)
    information = box_mean(slope * slope, 9) * disparity_px * disparity_px
    scale = 1.0 / (information + 1e-4)
    return (slope_change * disparity_px * scale).clamp(-1.5, 1.5), information * scale


def stereo_cue(left, right, prior_m, focal_baseline_px_m):
    """What the right camera says about ln(prior / depth) (models/inputs/stereo_cue.hpp) -> [B,6,H,W]."""
    known = (prior_m > 0).to(prior_m.dtype)
    safe_prior_m = torch.where(prior_m > 0, prior_m, torch.ones_like(prior_m))
    disparity_px = known * focal_baseline_px_m.view(-1, 1, 1, 1) / safe_prior_m
    there = (right.amax((1, 2, 3), keepdim=True) > 0).to(left.dtype)
    warped, inside = warp(right.mean(1, keepdim=True), disparity_px)
    maps = [left.mean(1, keepdim=True), warped, inside * known * there, disparity_px]
    channels = []
    for factor in (1, 2, 4):
        small = [F.avg_pool2d(x, factor, factor, 0, ceil_mode=True) if factor > 1 else x for x in maps]
        small[3] = small[3] / factor
        for channel in cue_at_scale(*small):
            if factor > 1:
                channel = F.interpolate(channel, left.shape[2:], mode="bilinear", align_corners=False)
            channels.append(channel)
    return torch.cat(channels, 1)


# --- the network -------------------------------------------------------------------------------------------------


def conv_block(in_channels, out_channels, kernel, stride, normalization, relu=True):
    conv = nn.Conv2d(
        in_channels, out_channels, kernel, stride, kernel // 2, bias=normalization == "none"
    )
    nn.init.kaiming_normal_(conv.weight, mode="fan_out", nonlinearity="relu")
    layers = OrderedDict(conv=conv)
    if normalization == "batch":
        layers["norm"] = nn.BatchNorm2d(out_channels)
    elif normalization == "group":
        layers["norm"] = nn.GroupNorm(math.gcd(out_channels, 8), out_channels)
    if relu:
        layers["relu"] = nn.ReLU(inplace=True)
    return nn.Sequential(layers)


class BasicBlock(nn.Module):
    """Two 3x3 convolutions around a shortcut: [B,in,H,W] -> [B,out,ceil(H/stride),ceil(W/stride)]."""

    def __init__(self, in_channels, out_channels, stride, normalization):
        super().__init__()
        self.first = conv_block(in_channels, out_channels, 3, stride, normalization)
        self.second = conv_block(out_channels, out_channels, 3, 1, normalization, relu=False)
        self.shortcut = None
        if stride != 1 or in_channels != out_channels:
            self.shortcut = conv_block(in_channels, out_channels, 1, stride, normalization, relu=False)

    def forward(self, x):
        residual = self.second(self.first(x))
        return torch.relu(residual + (self.shortcut(x) if self.shortcut is not None else x))


class ResnetEncoder(nn.Module):
    """ResNet-18 without its classifier: [B,in,H,W] -> five maps, the stem's and the four stages'."""

    def __init__(self, in_channels, widths, stem, normalization):
        super().__init__()
        self.downsample = stem == "downsample"
        kernel, stride = (7, 2) if self.downsample else (3, 1)
        self.stem = conv_block(in_channels, widths[0], kernel, stride, normalization)
        self.stages = []
        before = widths[0]
        for i, width in enumerate(widths):
            stage = nn.Sequential(
                BasicBlock(before, width, 1 if i == 0 else 2, normalization),
                BasicBlock(width, width, 1, normalization),
            )
            self.add_module(f"stage{i + 1}", stage)
            self.stages.append(stage)
            before = width

    def forward(self, x):
        maps = [self.stem(x)]
        x = F.max_pool2d(maps[0], 3, 2, 1) if self.downsample else maps[0]
        for stage in self.stages:
            x = stage(x)
            maps.append(x)
        return maps


class DepthCompletionNet(nn.Module):
    def __init__(self, config=None):
        super().__init__()
        c = self.config = config or Config()
        self.image_encoder = ResnetEncoder(c.image_channels, c.image_widths, c.stem, c.normalization)
        self.depth_encoder = ResnetEncoder(c.depth_channels, c.depth_widths, c.stem, c.normalization)
        fused = [i + (0 if c.fusion == "sum" else d) for i, d in zip(c.image_widths, c.depth_widths)]
        below = fused[3]
        self.decoder = []
        for i, skip in enumerate([fused[2], fused[1], fused[0], fused[0], 0]):
            level = conv_block(below + skip, c.decoder_widths[i], 3, 1, c.normalization)
            self.add_module(f"decoder{i + 1}", level)
            self.decoder.append(level)
            below = c.decoder_widths[i]
        self.detail = None
        if c.detail_width > 0:
            inputs = below + c.image_channels + c.depth_channels
            self.detail = conv_block(inputs, c.detail_width, 3, 1, c.normalization)
            below = c.detail_width
        self.head = nn.Conv2d(below, 3 if c.head == "gated" else 1, 3, padding=1)
        with torch.no_grad():
            self.head.weight.mul_(0.1)
            self.head.bias.zero_()

    def forward(self, left, sparse_m, right=None, prior_m=None, focal_baseline_px_m=None):
        """left, right [B,3,H,W] RGB in 0..1; sparse_m, prior_m [B,1,H,W] metres, 0 = missing; focal_baseline [B]."""
        image = self.image_input(left, right, prior_m, focal_baseline_px_m)
        depth = self.depth_input(sparse_m, prior_m)
        return self.decode(image, self.image_features(image), depth, self.depth_features(depth))

    def image_input(self, left, right=None, prior_m=None, focal_baseline_px_m=None):
        if not self.config.stereo:
            return left
        prior_m = torch.zeros_like(left[:, :1]) if prior_m is None else prior_m
        right = torch.zeros_like(left) if right is None else right
        if focal_baseline_px_m is None:
            focal_baseline_px_m = torch.zeros(left.shape[0], dtype=left.dtype)
        return torch.cat([left, stereo_cue(left, right, prior_m, focal_baseline_px_m)], 1)

    def depth_input(self, sparse_m, prior_m=None):
        c = self.config
        if c.depth_input == "raw":
            return sparse_m / c.depth_scale_m
        valid = (sparse_m > 0).to(sparse_m.dtype)
        if c.depth_input == "masked":
            return torch.cat([sparse_m / c.depth_scale_m, valid], 1)
        prior = torch.full_like(sparse_m, c.depth_scale_m)
        if c.prior == "altitude" and prior_m is not None:
            prior = torch.where(prior_m > 0, prior_m.clamp(c.min_depth_m, c.max_depth_m), prior)
        relative = (sparse_m.clamp(c.min_depth_m, c.max_depth_m) / prior).log() * valid
        fill, coarseness = fill_pyramid(relative, valid, c.fill_smoothing)
        return torch.cat([relative, valid, fill, coarseness, (prior / c.depth_scale_m).log()], 1)

    def image_features(self, image_input):
        return self.image_encoder(self._pad(image_input, "replicate"))

    def depth_features(self, depth_input):
        return self.depth_encoder(self._pad(depth_input, "constant"))

    def _pad(self, x, mode):
        stride = 32 if self.config.stem == "downsample" else 8
        right, below = -x.shape[3] % stride, -x.shape[2] % stride
        return F.pad(x, (0, right, 0, below), mode=mode) if right or below else x

    def decode(self, image_input, image_maps, depth_input, depth_maps):
        if self.config.fusion == "sum":
            fused = [image + depth for image, depth in zip(image_maps, depth_maps)]
        else:
            fused = [torch.cat(pair, 1) for pair in zip(image_maps, depth_maps)]
        x = fused[4]
        for level, skip in zip(self.decoder, reversed(fused[:4])):
            x = level(torch.cat([F.interpolate(x, skip.shape[2:], mode="nearest"), skip], 1))
        if self.config.stem == "downsample":
            x = F.interpolate(x, scale_factor=2.0, mode="nearest")
        x = self.decoder[4](x)[:, :, : depth_input.shape[2], : depth_input.shape[3]]
        if self.detail is not None:
            x = self.detail(torch.cat([x, image_input, depth_input], 1))
        return self._to_depth(self.head(x).float(), depth_input)  # autocast's bfloat16 ends here

    def _to_depth(self, raw, depth_input):
        c = self.config
        if c.head == "direct":
            return c.min_depth_m * torch.exp(torch.sigmoid(raw) * math.log(c.max_depth_m / c.min_depth_m))
        valid, fill, prior = depth_input[:, 1:2], depth_input[:, 2:3], depth_input[:, 4:5]
        gate = torch.sigmoid(raw[:, 1:2]) * valid.amax((2, 3), keepdim=True)
        from_prior = 2.0 * torch.tanh(raw[:, 0:1])
        from_fill = fill + 0.5 * torch.tanh(raw[:, 2:3])
        relative = from_prior + gate * (from_fill - from_prior)
        return (c.depth_scale_m * torch.exp(prior + relative)).clamp(c.min_depth_m, c.max_depth_m)
