"""scripts/peers/model.py computes what the C++ network computes: model_py_test.py PEER_SAMPLES.

PEER_SAMPLES is the program that writes checkpoints, inputs and depths. Exit code 77: torch is missing.
"""

import pathlib
import subprocess
import sys
import tempfile

try:
    import torch
    import yaml  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}; scripts/setup.sh --full installs python3-torch")
    sys.exit(77)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts" / "peers"))
from model import DepthCompletionNet, altitude_planes, load_network  # noqa: E402

TOLERANCE = 1e-4  # relative


def largest_error(actual, expected):
    assert actual.shape == expected.shape, f"{actual.shape} in place of {expected.shape}"
    return ((actual - expected).abs() / expected.abs().clamp_min(1e-6)).max().item()


@torch.no_grad()
def errors_of(checkpoint):
    net, config = load_network(checkpoint)
    s = torch.jit.load(str(checkpoint.with_suffix(".tensors.pt")))
    height_px, width_px = s.left.shape[2:]
    prior_m = altitude_planes(
        s.height_m, s.down_camera, s.intrinsics_px, height_px, width_px, config.max_depth_m
    )
    cameras = (s.right, prior_m, s.focal_baseline_px_m)
    errors = {
        "prior_m": largest_error(prior_m, s.prior_m),
        "depth_m": largest_error(net(s.left, s.sparse_m, *cameras), s.depth_m),
        "depth_without_points_m": largest_error(
            net(s.left, torch.zeros_like(s.sparse_m), *cameras), s.depth_without_points_m
        ),
        "depth_of_left_alone_m": largest_error(net(s.left, s.sparse_m), s.depth_of_left_alone_m),
    }
    # The comparison means something only where the network's answer depends on what it is given.
    assert largest_error(s.depth_m, s.depth_without_points_m) > 0.01
    net.train()
    errors["depth_in_training_m"] = largest_error(net(s.left, s.sparse_m, *cameras), s.depth_in_training_m)
    fresh = DepthCompletionNet(config).state_dict()
    assert fresh.keys() == net.state_dict().keys() == torch.jit.load(str(checkpoint)).weights.keys()
    return errors


def compare(program, folder):
    subprocess.run([program, str(folder)], check=True)
    checkpoints = sorted(p for p in folder.glob("*.pt") if not p.name.endswith(".tensors.pt"))
    assert len(checkpoints) >= 6, f"only {len(checkpoints)} checkpoints in {folder}"
    failed = False
    for checkpoint in checkpoints:
        for name, error in errors_of(checkpoint).items():
            print(f"{checkpoint.stem:24} {name:24} {error:.1e}")
            failed |= not error < TOLERANCE
    sys.exit("model.py and C++ disagree" if failed else 0)


with tempfile.TemporaryDirectory() as work:
    compare(sys.argv[1], pathlib.Path(work))
