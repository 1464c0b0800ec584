"""The training step of alight-train in Python, to measure against: same network, losses, data, optimizer.

    alight-train --config FILE --print-config > resolved.yaml
    train.py --config resolved.yaml [--steps N]    steps with and without loading; prints a line of JSON
    train.py --check STEP_SAMPLES                  same losses and gradients as C++? (tests/train/step_samples.cpp)
    train.py --table FILE                           a Markdown table of the lines that train.sh collects

Needs Debian's python3-torch python3-yaml python3-numpy python3-opencv, run by /usr/bin/python3. Augmentation and
accumulation are not made here; a configuration that asks for them is refused. Exit code 77: a package is missing.
"""

import argparse
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time
from contextlib import nullcontext
from statistics import median

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "peers"))
try:
    import torch
    import yaml
    from depth_data import DepthDataset, sample_density
except ImportError as missing:
    print(f"skipped: {missing}; scripts/setup.sh --full installs what is needed", file=sys.stderr)
    sys.exit(77)

from losses import terms
from model import Config, DepthCompletionNet, altitude_planes, load_network

WARM_UP_STEPS = 2
TOLERANCE = 1e-4  # relative


class Loader(yaml.SafeLoader):
    """PyYAML takes 2e-04, which has no point, for a string."""


Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"[-+]?\d+(\.\d*)?[eE][-+]?\d+$"), list("-+0123456789")
)


def predict(net, batch, image, right, sparse_m, knows_height):
    """Plane depth [B,1,H,W] (train/network_pass.hpp)."""
    c, k = net.config, batch["intrinsics_px"]
    height_px, width_px = image.shape[2:]
    ray = torch.ones(())
    if c.depth_kind == "perspective":  # lengths of the viewing rays at plane depth 1
        column = lambda i: k[:, i].view(-1, 1, 1, 1)
        x = (torch.arange(width_px).view(1, 1, 1, -1) - column(2)) / column(0)
        y = (torch.arange(height_px).view(1, 1, -1, 1) - column(3)) / column(1)
        ray = (x * x + y * y + 1).sqrt()
    height_m = torch.where(knows_height, batch["height_m"], torch.full_like(batch["height_m"], float("nan")))
    prior_m = altitude_planes(height_m, batch["down_camera"], k, height_px, width_px, c.max_depth_m)
    return net(image, sparse_m * ray, right, prior_m * ray, k[:, 0] * batch["baseline_m"]) / ray


class Step:
    """What alight-train does with a batch."""

    def __init__(self, config):
        self.config, compute, optimizer = config, config["compute"], config["optimizer"]
        last = compute["memory_format"] == "channels_last"
        self.format = torch.channels_last if last else torch.contiguous_format
        self.bfloat16 = compute["precision"] == "bfloat16"
        self.net = DepthCompletionNet(Config(**config["model"])).train().to(memory_format=self.format)
        self.parameters = list(self.net.parameters())
        decay = optimizer["weight_decay"] if optimizer["kind"] == "adamw" else 0
        groups = [
            {"params": [p for p in self.parameters if p.dim() > 1], "weight_decay": decay},
            {"params": [p for p in self.parameters if p.dim() <= 1], "weight_decay": 0},
        ]
        adam = torch.optim.AdamW if decay else torch.optim.Adam
        self.optimizer = adam(groups, lr=optimizer["learning_rate"])
        self.average = [t.detach().clone() for t in self.parameters] if optimizer["average_decay"] else []

    def __call__(self, batch):
        images = {n: batch[n].to(memory_format=self.format) for n in ("left", "right", "previous", "next")}
        batch = {**batch, **images}
        fed = sample_density(batch, self.config["density"])
        with torch.autocast("cpu", dtype=torch.bfloat16) if self.bfloat16 else nullcontext():
            prediction_m = predict(self.net, batch, *fed)
        loss = terms(self.config, batch, prediction_m, fed[2])
        self.optimizer.zero_grad(set_to_none=True)
        loss["total"].backward()
        if self.config["optimizer"]["clip_gradient_norm"] > 0:
            torch.nn.utils.clip_grad_norm_(self.parameters, self.config["optimizer"]["clip_gradient_norm"])
        self.optimizer.step()
        with torch.no_grad():
            for slow, fast in zip(self.average, self.parameters):
                slow.lerp_(fast, 1 - self.config["optimizer"]["average_decay"])
        return {n: t.item() for n, t in loss.items()}


# --- measuring ---------------------------------------------------------------------------------------------------


def refuse(config):
    asked = [n for n, p in config["augmentation"].items() if n.endswith("_probability") and p > 0]
    if asked or config["optimizer"]["accumulate"] != 1:
        sys.exit(f"error: not made here, set them to 0 and optimizer.accumulate to 1: {asked}")


def forever(loader):
    while True:
        yield from loader


def speeds(step, next_batch, images, steps):
    """Images a second of each step after the warm-up."""
    result = []
    for i in range(-WARM_UP_STEPS, steps):
        start = time.perf_counter()
        losses = step(next_batch())
        if i >= 0:
            result.append(images / (time.perf_counter() - start))
    assert all(map(lambda x: x == x, losses.values())), f"a loss is not a number: {losses}"
    return {"min": min(result), "median": median(result), "max": max(result)}


def measure(config, steps):
    refuse(config)
    loop = config["train"]
    torch.set_num_threads(config["compute"]["threads"] or os.cpu_count())
    torch.set_flush_denormal(True)  # as alight-train
    torch.manual_seed(loop["seed"])
    data = DepthDataset(config["dataset"], config["split"]["unknown_flights"], loop["crop_px"])
    loader = torch.utils.data.DataLoader(
        data, loop["batch_size"], shuffle=True, drop_last=True, num_workers=loop["workers"]
    )
    step, batches = Step(config), forever(loader)
    result = {"loading_images_per_s": speeds(step, lambda: next(batches), loop["batch_size"], steps)}
    batch = next(batches)
    batches.close()  # ends the worker, which would go on reading
    result["fixed_images_per_s"] = speeds(step, lambda: batch, loop["batch_size"], steps)
    megabytes = lambda who: resource.getrusage(who).ru_maxrss * 1024e-6
    result["peak_memory_mb"] = megabytes(resource.RUSAGE_SELF)
    result["worker_peak_memory_mb"] = megabytes(resource.RUSAGE_CHILDREN)  # shares pages with the process above
    result["torch"] = torch.__version__
    return result


# --- checking ----------------------------------------------------------------------------------------------------


def errors_of(checkpoint):
    """Relative differences to C++, of the prediction, every loss term and the gradient."""
    net, _ = load_network(checkpoint)
    config = yaml.load(torch.jit.load(str(checkpoint)).train_config, Loader)
    batch = torch.jit.load(str(checkpoint.with_suffix(".tensors.pt"))).state_dict()
    prediction_m = predict(
        net.train(), batch, batch["left"], batch["right"], batch["input_m"], batch["knows_height"]
    )
    losses = terms(config, batch, prediction_m, batch["input_m"])
    losses["total"].backward()
    losses["prediction_m"] = prediction_m
    losses["gradient_norm"] = torch.stack([p.grad.square().sum() for p in net.parameters()]).sum().sqrt()
    for value in losses.values():  # nothing is proved by terms that are zero
        assert (value > 0).all()
    return {n: ((v - batch[n]).abs() / batch[n].abs()).max().item() for n, v in losses.items()}


def check(program):
    with tempfile.TemporaryDirectory() as folder:
        compare(program, pathlib.Path(folder))


def compare(program, folder):
    subprocess.run([program, folder], check=True)
    checkpoints = [p for p in sorted(folder.glob("*.pt")) if not p.name.endswith(".tensors.pt")]
    assert len(checkpoints) >= 3, f"only {len(checkpoints)} checkpoints in {folder}"
    failed = False
    for checkpoint in checkpoints:
        for name, error in errors_of(checkpoint).items():
            print(f"{checkpoint.stem:16} {name:14} {error:.1e}")
            failed |= not error < TOLERANCE
    sys.exit("Python and C++ disagree" if failed else 0)


# --- the table ---------------------------------------------------------------------------------------------------


def cell(values, digits):
    return f"{median(values):.{digits}f} ({min(values):.{digits}f}..{max(values):.{digits}f})"


def table(path):
    """Medians of the rounds, their range, and ours / peer. Lines: {"form":, "who": "ours" or "peer", "result":}."""
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    print("| numbers in | | ours | peer | ours / peer |\n|---|---|---|---|---|")
    rows = [("loading_images_per_s", "images/s with loading", 2), ("fixed_images_per_s", "images/s, fixed batch", 2)]
    for form in dict.fromkeys(line["form"] for line in lines):
        of = lambda who: [x["result"] for x in lines if x["form"] == form and x["who"] == who]
        for key, title, digits in rows:
            ours, peer = ([r[key]["median"] for r in of(who)] for who in ("ours", "peer"))
            ratio = median(ours) / median(peer)
            print(f"| {form} | {title} | {cell(ours, digits)} | {cell(peer, digits)} | {ratio:.2f} |")
        ours, peer = ([r["peak_memory_mb"] for r in of(who)] for who in ("ours", "peer"))
        print(f"| {form} | peak memory, MB | {cell(ours, 0)} | {cell(peer, 0)} | {median(ours) / median(peer):.2f} |")
        peak = [r["convolution_gflop_per_s"]["median"] for r in of("ours")]
        work = 3 * of("ours")[0]["network_gflop"]
        share = [
            cell([100 * work * r["fixed_images_per_s"]["median"] / median(peak) for r in of(who)], 1)
            for who in ("ours", "peer")
        ]
        print(f"| {form} | % of the convolution's {cell(peak, 0)} GFLOP/s | {share[0]} | {share[1]} | |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--config", type=pathlib.Path)
    what.add_argument("--check", metavar="STEP_SAMPLES")
    what.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--steps", type=int, default=10)
    options = parser.parse_args()
    if options.check:
        check(options.check)
    elif options.table:
        table(options.table)
    else:
        print(json.dumps(measure(yaml.load(options.config.read_text(), Loader), options.steps)))


if __name__ == "__main__":
    main()
