"""Every exported graph in FOLDER, run by ONNX Runtime, gives the numbers that C++ wrote beside it."""

import pathlib
import sys

import numpy as np
import onnxruntime

TOLERANCE = 1e-4  # of the largest value, and for depth of each value


def read(path, shape):
    return np.fromfile(path, np.float32).reshape(shape)


def main():
    folder = pathlib.Path(sys.argv[1])
    models = sorted(folder.glob("*.onnx"))
    assert len(models) >= 18, f"only {len(models)} models in {folder}"
    failed = False
    for model in models:
        variant = model.name.split(".")[0]
        session = onnxruntime.InferenceSession(str(model), providers=["CPUExecutionProvider"])
        assert "depth_input" in session.get_modelmeta().custom_metadata_map["alight.model_config"]
        tensor = lambda port: read(folder / f"{variant}.{port.name}.f32", port.shape)
        results = session.run(None, {port.name: tensor(port) for port in session.get_inputs()})
        for port, actual in zip(session.get_outputs(), results):
            expected = tensor(port)
            scale = np.abs(expected) if port.name == "depth_m" else np.abs(expected).max()
            error = np.max(np.abs(actual - expected) / scale)
            print(f"{model.name:40} {port.name:18} {error:.1e}")
            failed |= not error < TOLERANCE
    sys.exit("ONNX Runtime and C++ disagree" if failed else 0)


main()
