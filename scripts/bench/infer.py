"""Peers of the onboard network, for scripts/bench/infer.sh.

    infer.py torch|onnxruntime|openvino MODEL DUMP RUNS THREADS    times MODEL on DUMP's inputs; prints a line of JSON
    infer.py table FILE                                          a Markdown table of the lines collected there

MODEL is a checkpoint for torch (scripts/peers/model.py computes it), an ONNX file for the others. Median and 95th percentile of
the learned part, and how far its depth is from what alight-infer computed in float32.
"""

import json
import pathlib
import sys
import time
from collections import defaultdict

WARM_UP_RUNS = 3


def percentile(values, share):
    return sorted(values)[min(int(share * len(values)), len(values) - 1)]


def main_peer(peer, model, dump, runs, threads):
    import numpy as np

    def read(name):
        values = np.fromfile(pathlib.Path(dump) / f"{name}.f32", np.float32)
        side = 352
        return values.reshape(1, -1, side, side)

    image, depth, expected = read("image_input"), read("depth_input"), read("depth_m")
    if peer == "torch":
        import torch

        sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "peers"))
        from model import load_network

        torch.set_num_threads(threads)
        torch.set_flush_denormal(True)
        torch.set_grad_enabled(False)
        net = load_network(model)[0].eval()
        image, depth = torch.from_numpy(image), torch.from_numpy(depth)

        def run():
            return net.decode(image, net.image_features(image), depth, net.depth_features(depth)).numpy()

    elif peer == "onnxruntime":
        import onnxruntime

        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = threads
        session = onnxruntime.InferenceSession(model, options, providers=["CPUExecutionProvider"])
        feeds = {port.name: image if "image" in port.name else depth for port in session.get_inputs()}
        run = lambda: session.run(None, feeds)[0]
    else:
        import openvino

        precision = "bf16" if peer == "openvino_bfloat16" else "f32"
        compiled = openvino.Core().compile_model(
            model, "CPU", {"INFERENCE_NUM_THREADS": threads, "INFERENCE_PRECISION_HINT": precision,
                           "PERFORMANCE_HINT": "LATENCY"})
        feeds = {port.any_name: image if "image" in port.any_name else depth for port in compiled.inputs}
        request = compiled.create_infer_request()
        run = lambda: list(request.infer(feeds).values())[0]

    times_ms = []
    for i in range(-WARM_UP_RUNS, runs):
        begin = time.perf_counter()
        result = run()
        if i >= 0:
            times_ms.append(1e3 * (time.perf_counter() - begin))
    error = np.abs(np.asarray(result).reshape(-1) / expected.reshape(-1) - 1)
    print(json.dumps({"median_ms": percentile(times_ms, 0.5), "p95_ms": percentile(times_ms, 0.95),
                      "largest_relative_error": float(error.max())}))


def main_table(path):
    import statistics

    rows = defaultdict(list)
    for line in pathlib.Path(path).read_text().splitlines():
        entry = json.loads(line)
        rows[entry["who"]].append(entry["result"])
    medians = {who: [r["median_ms"] for r in results] for who, results in rows.items()}
    peers = [who for who in medians if not who.startswith("ours") and "bfloat16" not in who]
    fastest = min(peers, key=lambda who: statistics.median(medians[who])) if peers else None
    print("| learned part, a full pass | median ms | p95 ms | fastest float32 peer / this | depth differs by at most |")
    print("|---|---:|---:|---:|---:|")
    for who, results in rows.items():
        median = statistics.median(medians[who])
        p95 = statistics.median(r["p95_ms"] for r in results)
        ratio = f"{statistics.median(medians[fastest]) / median:.2f}" if fastest else "-"
        error = max(r.get("largest_relative_error", 0) for r in results)
        print(f"| {who} | {median:.1f} ({min(medians[who]):.1f}..{max(medians[who]):.1f}) | {p95:.1f} | {ratio} | "
              f"{100 * error:.2g} % |")


if sys.argv[1] == "table":
    main_table(sys.argv[2])
else:
    main_peer(sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4]), int(sys.argv[5]))
