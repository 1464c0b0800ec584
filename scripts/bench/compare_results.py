#!/usr/bin/python3
"""Compares two folders that alight-infer wrote from the same log: verdicts and depth of every image.

    compare_results.py out/here out/there
    compare_results.py out/here out/there --tolerance 1e-3

Both runs need `--set depth_every=1`. They agree if every image has the same source of depth, a site in both or in none, the
same acceptance, and at every pixel a depth in both or in none, apart by no more than the tolerance, relative. Exit code 1
if they do not, 2 for a mistake in usage. Needs python3-numpy and python3-opencv.
"""

import argparse
import json
import pathlib
import sys

try:
    import cv2
    import numpy as np
except ImportError as error:
    sys.exit(f"compare_results: {error}; apt-get install python3-numpy python3-opencv, and run /usr/bin/python3")


def results_of(folder):
    """The lines of results.jsonl, by time."""
    path = folder / "results.jsonl"
    try:
        lines = [json.loads(line) for line in path.read_text().splitlines()]
    except (OSError, ValueError) as error:
        sys.exit(f"compare_results: {path}: {error}; name a folder that alight-infer wrote")
    return {line["t_ns"]: line for line in lines}


def depth_of(folder, result):
    """[H,W] float32, metres, 0 = unknown; None for an image without depth."""
    if result["source"] == "none":
        return None
    path = folder / "depth" / f"{result['t_ns']}.tiff"
    depth_m = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    if depth_m is None:
        sys.exit(f"compare_results: {path}: is missing or no depth map; run alight-infer with --set depth_every=1")
    return depth_m


def site_state(result):
    if result["site"] is None:
        return "none"
    return "accepted" if result["site"]["accepted"] else "candidate"


class DepthDifference:
    """How far two depth maps are apart, relative to the first."""

    def __init__(self, a_m, b_m, tolerance):
        self.pixels = 0
        self.apart = 0  # more than the tolerance, or known in one alone
        self.largest = 0.0
        if a_m is None or b_m is None:
            return
        if a_m.shape != b_m.shape:
            sys.exit(f"compare_results: depth maps of {a_m.shape} and {b_m.shape}; the two runs had other configurations")
        either = (a_m > 0) | (b_m > 0)
        both = (a_m > 0) & (b_m > 0)
        relative = np.abs(b_m[both].astype(np.float64) - a_m[both]) / a_m[both]
        self.pixels = int(either.sum())
        self.apart = int((relative > tolerance).sum()) + self.pixels - int(both.sum())
        self.largest = float(relative.max()) if relative.size else 0.0


def distance_m(a, b):
    """Between the two sites in the world; None where one is missing."""
    if a["site"] is None or b["site"] is None:
        return None
    return float(np.linalg.norm(np.subtract(a["site"]["p_world"], b["site"]["p_world"])))


def both(a, b):
    return a if a == b else f"{a} | {b}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("a", type=pathlib.Path)
    parser.add_argument("b", type=pathlib.Path)
    parser.add_argument("--tolerance", type=float, default=1e-3, help="of the depth, relative (default: %(default)s)")
    options = parser.parse_args()
    first, second = results_of(options.a), results_of(options.b)
    if not first or first.keys() != second.keys():
        sys.exit(f"compare_results: {len(first)} and {len(second)} images, or of other times; compare runs of one log")

    print(f"{'image':>5}  {'source':<19} {'site':<21} {'site apart mm':>13} {'pixels':>8} {'apart':>6} {'largest':>9}")
    verdicts, pixels, apart, largest = 0, 0, 0, 0.0
    for number, t_ns in enumerate(sorted(first), 1):
        a, b = first[t_ns], second[t_ns]
        depth = DepthDifference(depth_of(options.a, a), depth_of(options.b, b), options.tolerance)
        verdicts += (a["source"], site_state(a)) == (b["source"], site_state(b))
        pixels, apart, largest = pixels + depth.pixels, apart + depth.apart, max(largest, depth.largest)
        site_m = distance_m(a, b)
        print(f"{number:>5}  {both(a['source'], b['source']):<19} {both(site_state(a), site_state(b)):<21} "
              f"{'-' if site_m is None else format(site_m * 1e3, '.3f'):>13} {depth.pixels:>8} {depth.apart:>6} "
              f"{depth.largest:>9.1e}")
    share = 100.0 * (pixels - apart) / pixels if pixels else 0.0
    print(f"\nverdicts: the same for {verdicts} of {len(first)} images")
    print(f"depth: {share:.4f} % of {pixels} pixels within {options.tolerance:g}, relative; the largest difference {largest:.1e}")
    agree = verdicts == len(first) and apart == 0 and pixels > 0
    print("they agree" if agree else "they DISAGREE")
    return 0 if agree else 1


if __name__ == "__main__":
    sys.exit(main())
