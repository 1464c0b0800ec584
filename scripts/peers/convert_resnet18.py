#!/usr/bin/python3
"""Turns torchvision's ResNet-18, trained on ImageNet, into a start for the network's image encoder:

    scripts/peers/convert_resnet18.py resnet18-f37072fd.pth resnet18.pt

resnet18-f37072fd.pth is what torchvision.models.resnet18 downloads. The result is for networks with stem: downsample,
normalization: batch and image_widths: [64, 128, 256, 512]; channels of the image input beyond RGB start at 0.

torchvision wants colours less ImageNet's mean, over its deviation; Alight feeds RGB in 0..1. Both go into the first
convolution and the normalisation behind it, so that the features are the same, but for the border: a convolution pads
with 0, which is black here and the mean colour there. Needs torch (Debian: python3-torch).
"""

import argparse
import os
import pickle
import re
import sys
from typing import Dict

try:
    import torch
except ImportError as missing:
    sys.exit(f"convert_resnet18: {missing}; scripts/setup.sh --full installs python3-torch for /usr/bin/python3")

MEAN = torch.tensor([0.485, 0.456, 0.406])
DEVIATION = torch.tensor([0.229, 0.224, 0.225])

LAYERS = {"conv1": "first.conv", "bn1": "first.norm", "conv2": "second.conv", "bn2": "second.norm"}
LAYERS.update({"downsample.0": "shortcut.conv", "downsample.1": "shortcut.norm"})
CONV = ("weight",)
NORM = ("weight", "bias", "running_mean", "running_var", "num_batches_tracked")
IN_BLOCK = re.compile(r"layer([1-4])\.([01])\.(conv1|bn1|conv2|bn2|downsample\.[01])\.(\w+)")


def expected_shapes():
    """ResNet-18's tensors, torchvision's names -> shapes."""
    shapes = {}

    def add(conv, norm, *shape):
        shapes[f"{conv}.weight"] = shape
        shapes.update({f"{norm}.{part}": shape[:1] for part in NORM})
        shapes[f"{norm}.num_batches_tracked"] = ()

    add("conv1", "bn1", 64, 3, 7, 7)
    before = 64
    for stage, width in enumerate((64, 128, 256, 512), 1):
        for block in ("0", "1"):
            prefix = f"layer{stage}.{block}."
            add(prefix + "conv1", prefix + "bn1", width, before, 3, 3)
            add(prefix + "conv2", prefix + "bn2", width, width, 3, 3)
            if before != width:
                add(prefix + "downsample.0", prefix + "downsample.1", width, before, 1, 1)
            before = width
    return shapes


def encoder_name(name):
    """layer2.0.bn1.bias -> image_encoder.stage2.0.first.norm.bias"""
    in_block = IN_BLOCK.fullmatch(name)
    if in_block:
        stage, block, layer, part = in_block.groups()
        return f"image_encoder.stage{stage}.{block}.{LAYERS[layer]}.{part}"
    layer, part = name.split(".")
    return f"image_encoder.stem.{ {'conv1': 'conv', 'bn1': 'norm'}[layer] }.{part}"


def convert(state):
    """torchvision's state dict -> named tensors of the image encoder. Raises ValueError if it is another network's."""
    shapes = expected_shapes()
    state = {name: value for name, value in state.items() if not name.startswith("fc.")}  # the classifier
    for name, shape in shapes.items():
        if name not in state and name.endswith("num_batches_tracked"):  # files of before 2018 have none
            state[name] = torch.tensor(0)
        if name not in state:
            raise ValueError(f"no ResNet-18 of torchvision: it has no {name}")
        if tuple(state[name].shape) != shape:
            raise ValueError(f"no ResNet-18 of torchvision: {name} is {list(state[name].shape)}, not {list(shape)}")
    unknown = sorted(set(state) - set(shapes))
    if unknown:
        raise ValueError(f"no ResNet-18 of torchvision: it has {unknown[0]} besides")
    weight = state["conv1.weight"] / DEVIATION.view(1, 3, 1, 1)
    # conv((x - mean) / deviation) = conv'(x) - shift; the normalisation behind it takes its mean away anyway.
    shift = (weight * MEAN.view(1, 3, 1, 1)).sum((1, 2, 3))
    state["conv1.weight"] = weight
    state["bn1.running_mean"] = state["bn1.running_mean"] + shift
    return {encoder_name(name): state[name].detach().clone().contiguous() for name in shapes}


class Weights(torch.nn.Module):
    """Saved by TorchScript this is what torch::serialize::InputArchive reads, as in a checkpoint."""

    weights: Dict[str, torch.Tensor]
    alight_checkpoint_version: int

    def __init__(self, weights):
        super().__init__()
        self.weights = weights
        self.alight_checkpoint_version = 2

    def forward(self):
        return self.weights


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("state_dict", help="torchvision's .pth file")
    parser.add_argument("output", help="file for train.image_encoder_weights")
    arguments = parser.parse_args()
    try:
        state = torch.load(arguments.state_dict, map_location="cpu", weights_only=True)
        weights = convert(state)
    except (OSError, RuntimeError, EOFError, pickle.UnpicklingError, AttributeError) as error:
        sys.exit(f"{arguments.state_dict}: not readable as a state dict of PyTorch: {error}")
    except ValueError as error:
        sys.exit(f"{arguments.state_dict}: {error}; give the .pth file of torchvision.models.resnet18")
    partial = arguments.output + ".partial"
    try:
        torch.jit.script(Weights(weights)).save(partial)
        os.replace(partial, arguments.output)
    except (OSError, RuntimeError) as error:
        sys.exit(f"{arguments.output}: cannot be written; check the folder and its rights: {error}")
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
