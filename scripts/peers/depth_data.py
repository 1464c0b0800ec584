"""A data set of alight-dataset (docs/formats.md) as a torch Dataset, and the density sampling of training, in Python.

Needs torch, numpy, yaml and OpenCV (Debian: python3-torch python3-numpy python3-yaml python3-opencv).
"""

import csv
import math
import pathlib

import cv2
import numpy as np
import torch
import yaml

FORMAT_VERSION = 1
OFFSET_ZERO = 32768  # of the 16-bit file: no offset


def pose_of(row):
    """T_world_camera of a line of samples.csv, [4,4] float64."""
    w, x, y, z = (float(row[k]) for k in ("qw", "qx", "qy", "qz"))
    T = np.eye(4)
    T[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    T[:3, 3] = [float(row[k]) for k in ("x_m", "y_m", "z_m")]
    return T


class DepthDataset(torch.utils.data.Dataset):
    """Random square cut-outs, dictionaries with the fields of train/data/batch.hpp."""

    def __init__(self, folder, left_out_flights=(), crop_px=None):
        self.folder, self.crop_px = pathlib.Path(folder), crop_px
        self.info = yaml.safe_load((self.folder / "dataset.yaml").read_text())
        if self.info["format_version"] != FORMAT_VERSION:
            raise ValueError(f"{folder}: format version {self.info['format_version']} is not {FORMAT_VERSION}")
        self.samples = []  # (flight, its lines, line)
        for flight in self.info["flights"]:
            if flight["name"] in left_out_flights:
                continue
            with open(self.folder / flight["name"] / "samples.csv") as file:
                lines = list(csv.DictReader(file))
            self.samples += [(flight, lines, line) for line in range(len(lines))]

    def __len__(self):
        return len(self.samples)

    def _read(self, flight, kind, index, window):
        path = self.folder / flight["name"] / kind / f"{int(index):06d}.png"
        image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        if image is None:
            raise ValueError(f"{path}: cannot be read")
        return image[window]

    def _image(self, flight, kind, index, window):
        """[3,h,w] RGB in 0..1."""
        image = self._read(flight, kind, index, window)
        image = cv2.cvtColor(image, cv2.COLOR_GRAY2RGB if image.ndim == 2 else cv2.COLOR_BGR2RGB)
        return torch.from_numpy(image.transpose(2, 0, 1).astype(np.float32) * np.float32(1 / 255))

    def _window(self):
        rig = self.info["rig"]
        height, width = self.crop_px or rig["height_px"], self.crop_px or rig["width_px"]
        room = (rig["height_px"] - height, rig["width_px"] - width)
        if min(room) < 0:
            raise ValueError(f"{self.folder}: cut-outs of {width}x{height} px do not fit the images")
        row, column = (int(torch.randint(0, r + 1, ())) for r in room)
        return np.s_[row : row + height, column : column + width], row, column

    def __getitem__(self, i):
        flight, lines, line = self.samples[i]
        rig, row = self.info["rig"], lines[line]
        window, top, left = self._window()
        pose = pose_of(row)
        sample = {"left": self._image(flight, "left", row["index"], window)}
        sample["has_right"] = flight["has_right"]
        zeros = torch.zeros_like(sample["left"])
        sample["right"] = self._image(flight, "right", row["index"], window) if flight["has_right"] else zeros
        for name in ("previous", "next"):
            there = sample["has_" + name] = int(row[name]) >= 0
            sample[name] = self._image(flight, "left", row[name], window) if there else zeros
            T = np.linalg.inv(pose_of(lines[int(row[name])])) @ pose if there else np.eye(4)
            sample[f"T_{name}_camera"] = torch.from_numpy(T).float()
        depth = self._read(flight, "depth", row["index"], window).astype(np.float32)
        offset = self._read(flight, "offset", row["index"], window).astype(np.float32)
        sample["sparse_m"] = torch.from_numpy(depth[None] * np.float32(1 / self.info["depth_scale"]))
        offset_s = np.where(offset > 0, (offset - OFFSET_ZERO) * np.float32(1e-3), np.float32(0))
        sample["offset_s"] = torch.from_numpy(offset_s[None])
        k = [rig["fx_px"], rig["fy_px"], rig["cx_px"] - left, rig["cy_px"] - top]
        sample["intrinsics_px"] = torch.tensor(k, dtype=torch.float32)
        sample["baseline_m"] = torch.tensor(rig["baseline_m"], dtype=torch.float32)
        sample["height_m"] = torch.tensor(float(row["height_m"]), dtype=torch.float32)
        sample["down_camera"] = torch.from_numpy(-pose[2, :3].copy()).float()
        return sample


def sample_density(batch, c):
    """Draws what is fed (train/data/density_sampling.hpp): image, right, sparse_m, knows_height."""
    count = len(batch["left"])
    image, right = batch["left"].clone(), batch["right"].clone()
    sparse_m, knows_height = batch["sparse_m"].clone(), torch.ones(count, dtype=torch.bool)
    lots = torch.rand(count, 8).tolist()
    for i in range(count):
        u = lots[0 if c["draw"] == "batch" else i]
        lidar = u[0] >= c["no_lidar_probability"]
        sees = not (lidar and u[2] < c["no_image_probability"])
        if not lidar:
            sparse_m[i] = 0
        elif c["mode"] == "window" or (c["mode"] == "mixed" and u[5] < 0.5):
            begin_s = c["window_begin_min_s"] + (c["window_begin_max_s"] - c["window_begin_min_s"]) * u[6]
            end_s = begin_s + c["window_min_s"] * math.pow(c["window_max_s"] / c["window_min_s"], u[7])
            sparse_m[i] *= (batch["offset_s"][i] >= begin_s) & (batch["offset_s"][i] < end_s)
        else:
            share = c["min_share"] + (c["max_share"] - c["min_share"]) * u[1]
            sparse_m[i] *= torch.rand(sparse_m[i].shape) < share
        if not sees:
            image[i] = 0
        if not (sees and u[3] >= c["no_right_probability"]):
            right[i] = 0
        knows_height[i] = u[4] >= c["no_height_probability"]
    return image, right, sparse_m, knows_height
