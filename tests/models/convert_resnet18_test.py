"""The image encoder computes what ResNet-18 computes, given its converted weights: convert_resnet18_test.py
PEER_SAMPLES. torchvision's weights have random numbers here; its network is written out below.

Exit code 77: torch is missing.
"""

import pathlib
import subprocess
import sys
import tempfile

try:
    import torch
    import torch.nn.functional as F
except ImportError as missing:
    print(f"skipped: {missing}; scripts/setup.sh --full installs python3-torch")
    sys.exit(77)

CONVERTER = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "peers" / "convert_resnet18.py"
MEAN = torch.tensor([0.485, 0.456, 0.406]).view(1, 3, 1, 1)
DEVIATION = torch.tensor([0.229, 0.224, 0.225]).view(1, 3, 1, 1)


def random_state():
    """torchvision's resnet18().state_dict() with other numbers."""
    state = {}

    def conv(name, *shape):
        state[name + ".weight"] = torch.randn(shape) * (2.0 / (shape[0] * shape[2] * shape[3])) ** 0.5

    def norm(name, channels):
        state[name + ".weight"] = 0.5 + torch.rand(channels)
        state[name + ".bias"] = 0.2 * torch.randn(channels)
        state[name + ".running_mean"] = 0.2 * torch.randn(channels)
        state[name + ".running_var"] = 0.5 + torch.rand(channels)
        state[name + ".num_batches_tracked"] = torch.tensor(5)

    conv("conv1", 64, 3, 7, 7)
    norm("bn1", 64)
    for stage, (before, width) in enumerate([(64, 64), (64, 128), (128, 256), (256, 512)], 1):
        for block, inputs in enumerate([before, width]):
            prefix = f"layer{stage}.{block}."
            conv(prefix + "conv1", width, inputs, 3, 3)
            norm(prefix + "bn1", width)
            conv(prefix + "conv2", width, width, 3, 3)
            norm(prefix + "bn2", width)
            if inputs != width:
                conv(prefix + "downsample.0", width, inputs, 1, 1)
                norm(prefix + "downsample.1", width)
    state["fc.weight"], state["fc.bias"] = torch.randn(1000, 512), torch.randn(1000)
    return state


def resnet18_features(state, rgb):
    """He et al. 2016, table 1, as torchvision computes it; the border is black, as Alight pads."""

    def norm(x, name):
        part = lambda p: state[f"{name}.{p}"]
        return F.batch_norm(x, part("running_mean"), part("running_var"), part("weight"), part("bias"))

    x = (F.pad(rgb, (3, 3, 3, 3)) - MEAN) / DEVIATION
    x = torch.relu(norm(F.conv2d(x, state["conv1.weight"], stride=2), "bn1"))
    features = [x]
    x = F.max_pool2d(x, 3, 2, 1)
    for stage in range(1, 5):
        for block in range(2):
            prefix = f"layer{stage}.{block}."
            stride = 2 if stage > 1 and block == 0 else 1
            y = F.conv2d(x, state[prefix + "conv1.weight"], stride=stride, padding=1)
            y = torch.relu(norm(y, prefix + "bn1"))
            y = norm(F.conv2d(y, state[prefix + "conv2.weight"], padding=1), prefix + "bn2")
            if prefix + "downsample.0.weight" in state:
                shortcut = F.conv2d(x, state[prefix + "downsample.0.weight"], stride=stride)
                x = norm(shortcut, prefix + "downsample.1")
            x = torch.relu(x + y)
        features.append(x)
    return features


def convert(folder, state):
    torch.save(state, folder / "resnet18.pth")
    command = [sys.executable, str(CONVERTER), str(folder / "resnet18.pth"), str(folder / "encoder.pt")]
    return subprocess.run(command, capture_output=True, text=True)


def check_features(program, folder):
    state = random_state()
    run = convert(folder, state)
    assert run.returncode == 0, run.stderr
    subprocess.run([program, "--image-encoder", folder / "encoder.pt", folder / "features.pt"], check=True)
    archive = torch.jit.load(str(folder / "features.pt"))
    for i, expected in enumerate(resnet18_features(state, archive.left)):
        actual = getattr(archive, f"features_{i + 1}")
        assert actual.shape == expected.shape
        error = ((actual - expected).abs().max() / expected.abs().max()).item()
        print(f"map {i + 1} {list(expected.shape)}: {error:.1e}")
        assert error < 1e-4, "the features differ"


def check_refusals(folder):
    def refused(words, change):
        state = random_state()
        change(state)
        (folder / "encoder.pt").unlink(missing_ok=True)
        run = convert(folder, state)
        assert run.returncode == 1 and "resnet18.pth: " in run.stderr and words in run.stderr, run.stderr
        assert not (folder / "encoder.pt").exists()

    refused("it has no layer3.0.bn2.bias", lambda s: s.pop("layer3.0.bn2.bias"))
    refused("it has layer1.2.conv1.weight besides", lambda s: s.update({"layer1.2.conv1.weight": torch.ones(1)}))
    refused("conv1.weight is [64, 1, 7, 7]", lambda s: s.update({"conv1.weight": torch.ones(64, 1, 7, 7)}))
    (folder / "text.pth").write_text("no weights")
    command = [sys.executable, str(CONVERTER), str(folder / "text.pth"), str(folder / "encoder.pt")]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 1 and "text.pth: not readable" in run.stderr, run.stderr


def main():
    torch.manual_seed(3)
    with tempfile.TemporaryDirectory() as work:
        check_features(sys.argv[1], pathlib.Path(work))
        check_refusals(pathlib.Path(work))


main()
