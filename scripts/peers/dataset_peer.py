#!/usr/bin/env python3
"""The peer of scripts/bench/dataset.sh: sparse depth maps of a ROS 1 bag with python3-rosbag, numpy and OpenCV.

Does for one log of the simulator's rig (rectified, livox_ros_driver/CustomMsg, DJI topics) what `alight-dataset build`
does: poses from attitude and position, every LiDAR point placed with the pose at its own time, the points of a window
around every n-th image projected into it, the one nearest in time kept where several meet; images, depth and time
offsets as PNG. numpy does all work on points; messages are read raw and their arrays viewed, not decoded one by one.

  scripts/peers/dataset_peer.py LOG.bag OUTPUT --rig configs/rigs/paper.yaml [--maps-only] [--crop 352] [--before 1] [--after 1]
                        [--every 4]
Prints one JSON line: maps, seconds. With --maps-only nothing is decoded, encoded or written.
"""
import argparse
import collections
import json
import pathlib
import struct
import time

import cv2
import numpy as np
import rosbag
import yaml

POINT = np.dtype([("offset_ns", "<u4"), ("xyz", "<f4", 3), ("reflectivity", "u1"), ("tag", "u1"), ("line", "u1")])
MIN_RANGE_M, MAX_RANGE_M, MIN_DEPTH_M, MAX_DEPTH_M = 0.5, 300.0, 0.5, 250.0


def header(data):
    """Stamp in ns, and where the bytes after the header begin."""
    _, seconds, nanoseconds, frame_bytes = struct.unpack_from("<4I", data)
    return seconds * 1_000_000_000 + nanoseconds, 16 + frame_bytes


def read_points(data):
    """Times in ns and positions in the LiDAR's frame of the echoes of a CustomMsg."""
    stamp, at = header(data)
    (count,) = struct.unpack_from("<I", data, at + 16)
    points = np.frombuffer(data, POINT, count, at + 20)
    range_m = np.linalg.norm(points["xyz"].astype(np.float64), axis=1)
    echo = (range_m >= MIN_RANGE_M) & (range_m <= MAX_RANGE_M)
    return stamp + points["offset_ns"][echo].astype(np.int64), points["xyz"][echo].astype(np.float64)


def read_image(data, compressed):
    """A sensor_msgs/CompressedImage, or a mono8 or bgr8 sensor_msgs/Image as a view."""
    _, at = header(data)
    if compressed:
        (format_bytes,) = struct.unpack_from("<I", data, at)
        return cv2.imdecode(np.frombuffer(data, np.uint8, offset=at + 4 + format_bytes + 4), cv2.IMREAD_UNCHANGED)
    height, width, encoding_bytes = struct.unpack_from("<3I", data, at)
    encoding = data[at + 12:at + 12 + encoding_bytes].decode()
    at += 12 + encoding_bytes + 1
    step, count = struct.unpack_from("<2I", data, at)
    channels = {"mono8": 1, "bgr8": 3}[encoding]
    rows = np.frombuffer(data, np.uint8, count, at + 8).reshape(height, step)[:, :width * channels]
    return rows if channels == 1 else rows.reshape(height, width, 3)


def enu(fixes):
    """Latitude, longitude (deg) and height (m) to East-North-Up at the first fix, WGS84."""
    a, e2 = 6378137.0, 6.69437999014e-3
    lat, lon = np.radians(fixes[:, 0]), np.radians(fixes[:, 1])
    n = a / np.sqrt(1 - e2 * np.sin(lat) ** 2)
    ecef = np.stack([(n + fixes[:, 2]) * np.cos(lat) * np.cos(lon), (n + fixes[:, 2]) * np.cos(lat) * np.sin(lon),
                     (n * (1 - e2) + fixes[:, 2]) * np.sin(lat)], 1)
    sa, ca, so, co = np.sin(lat[0]), np.cos(lat[0]), np.sin(lon[0]), np.cos(lon[0])
    rotation = np.array([[-so, co, 0], [-sa * co, -sa * so, ca], [ca * co, ca * so, sa]])
    return (ecef - ecef[0]) @ rotation.T


class Trajectory:
    def __init__(self, attitudes, positions):
        self.attitude_ns = np.array([t for t, _ in attitudes], np.int64)
        q = np.array([q for _, q in attitudes])
        flip = np.cumprod(np.where(np.sum(q[1:] * q[:-1], 1) < 0, -1, 1))
        q[1:] *= flip[:, None]
        self.q = q
        self.position_ns = np.array([t for t, _ in positions], np.int64)
        self.p = enu(np.array([p for _, p in positions]))
        self.begin_ns = max(self.attitude_ns[0], self.position_ns[0])
        self.end_ns = min(self.attitude_ns[-1], self.position_ns[-1])

    def at(self, t_ns):
        """Rotations [n,3,3] and translations [n,3] of the body in the world; slerp and linear."""
        i = np.clip(np.searchsorted(self.attitude_ns, t_ns, "right") - 1, 0, len(self.q) - 2)
        share = (t_ns - self.attitude_ns[i]) / (self.attitude_ns[i + 1] - self.attitude_ns[i])
        a, b = self.q[i], self.q[i + 1]
        angle = np.arccos(np.clip(np.sum(a * b, 1), -1, 1))
        small = angle < 1e-9
        sine = np.where(small, 1, np.sin(angle))
        wa = np.where(small, 1 - share, np.sin((1 - share) * angle) / sine)
        wb = np.where(small, share, np.sin(share * angle) / sine)
        x, y, z, w = (wa[:, None] * a + wb[:, None] * b).T
        rotation = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                             2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                             2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], 1).reshape(-1, 3, 3)
        j = np.clip(np.searchsorted(self.position_ns, t_ns, "right") - 1, 0, len(self.p) - 2)
        share = ((t_ns - self.position_ns[j]) / (self.position_ns[j + 1] - self.position_ns[j]))[:, None]
        return rotation, self.p[j] + share * (self.p[j + 1] - self.p[j])


def read_trajectory(bag):
    attitudes, positions = [], []
    for topic, (_, data, *_), _ in bag.read_messages(["/dji_sdk/attitude", "/dji_sdk/gps_position"], raw=True):
        t_ns, at = header(data)
        if topic == "/dji_sdk/attitude":
            attitudes.append((t_ns, struct.unpack_from("<4d", data, at)))
        else:
            positions.append((t_ns, struct.unpack_from("<3d", data, at + 3)))
    return Trajectory(attitudes, positions)


class Window:
    """Points placed in the world, a batch a LiDAR message."""

    def __init__(self, trajectory, T_imu_lidar):
        self.trajectory, self.T_imu_lidar, self.batches = trajectory, T_imu_lidar, collections.deque()
        self.until_ns = -1

    def add(self, data):
        t_ns, p_lidar = read_points(data)
        if len(t_ns) == 0:
            return
        known = (t_ns >= self.trajectory.begin_ns) & (t_ns <= self.trajectory.end_ns)
        t_ns, p_lidar = t_ns[known], p_lidar[known]
        p_imu = p_lidar @ self.T_imu_lidar[:3, :3].T + self.T_imu_lidar[:3, 3]
        rotation, translation = self.trajectory.at(t_ns)
        self.batches.append((t_ns, np.einsum("nij,nj->ni", rotation, p_imu) + translation))
        self.until_ns = max(self.until_ns, t_ns[-1] if len(t_ns) else -1)

    def points(self, begin_ns, end_ns):
        while self.batches and len(self.batches[0][0]) and self.batches[0][0][-1] < begin_ns:
            self.batches.popleft()
        chosen = [b for b in self.batches if len(b[0]) and b[0][0] <= end_ns]
        t_ns, p = np.concatenate([b[0] for b in chosen]), np.concatenate([b[1] for b in chosen])
        inside = (t_ns >= begin_ns) & (t_ns <= end_ns)
        return t_ns[inside], p[inside]


def depth_map(t_image_ns, t_ns, p_world, rotation, translation, k, size):
    """Plane depth in metres and time offset in us, [size,size]; 0 where no point fell."""
    p = (p_world - translation) @ rotation
    near = (p[:, 2] >= MIN_DEPTH_M) & (p[:, 2] <= MAX_DEPTH_M)
    p, t_ns = p[near], t_ns[near]
    u = np.floor(k[0] * p[:, 0] / p[:, 2] + k[2] + 0.5).astype(np.int64)
    v = np.floor(k[1] * p[:, 1] / p[:, 2] + k[3] + 0.5).astype(np.int64)
    inside = (u >= 0) & (u < size) & (v >= 0) & (v < size)
    pixel, depth_m = (v * size + u)[inside], p[inside, 2]
    offset_us = ((t_ns[inside] - t_image_ns) / 1000).astype(np.int64)
    order = np.lexsort((-depth_m, -np.abs(offset_us)))  # the last assignment to a pixel stays
    depth, offset = np.zeros(size * size), np.zeros(size * size, np.int64)
    depth[pixel[order]] = depth_m[order]
    offset[pixel[order]] = offset_us[order]
    return depth.reshape(size, size), offset.reshape(size, size)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--rig", required=True)
    parser.add_argument("--maps-only", action="store_true")
    parser.add_argument("--crop", type=int, default=352)
    parser.add_argument("--before", type=float, default=1.0)
    parser.add_argument("--after", type=float, default=1.0)
    parser.add_argument("--every", type=int, default=4)
    options = parser.parse_args()

    rig = yaml.safe_load(open(options.rig))
    T_camera_imu, T_camera_lidar = np.array(rig["cam0"]["T_cam_imu"]), np.array(rig["lidar0"]["T_cam_lidar"])
    T_imu_camera = np.linalg.inv(T_camera_imu)
    fx, fy, cx, cy = rig["cam0"]["intrinsics"]
    width, height = rig["cam0"]["resolution"]
    size = options.crop
    left, top = (width - size) // 2, (height - size) // 2
    k = (fx, fy, cx - left, cy - top)
    topics = {rig["lidar0"]["rostopic"]: "lidar"}
    for side, camera in (("left", "cam0"), ("right", "cam1")):
        topics[rig[camera]["rostopic"]] = topics[rig[camera]["rostopic"] + "/compressed"] = side
    before_ns, after_ns = int(options.before * 1e9), int(options.after * 1e9)
    if not options.maps_only:
        for name in ("left", "right", "depth", "offset"):
            (options.output / name).mkdir(parents=True, exist_ok=True)

    begin = time.perf_counter()
    png = [cv2.IMWRITE_PNG_COMPRESSION, 1]
    maps = 0
    with rosbag.Bag(options.log) as bag:
        trajectory = read_trajectory(bag)
        window = Window(trajectory, T_imu_camera @ T_camera_lidar)
        waiting, frames, seen = {}, collections.deque(), 0

        def finish_frames(until_ns):
            nonlocal maps
            while frames and frames[0][0] + after_ns <= until_ns:
                t_image_ns, images = frames.popleft()
                if not trajectory.begin_ns <= t_image_ns <= trajectory.end_ns:
                    continue
                rotation, translation = (x[0] for x in trajectory.at(np.array([t_image_ns])))
                T_world_imu = np.eye(4)
                T_world_imu[:3, :3], T_world_imu[:3, 3] = rotation, translation
                T_world_camera = T_world_imu @ T_imu_camera
                t_ns, p_world = window.points(t_image_ns - before_ns, t_image_ns + after_ns)
                depth, offset = depth_map(t_image_ns, t_ns, p_world, T_world_camera[:3, :3], T_world_camera[:3, 3], k, size)
                if not options.maps_only:
                    name = f"{maps:06d}.png"
                    for side in ("left", "right"):
                        image = read_image(*images[side])[top:top + size, left:left + size]
                        cv2.imwrite(str(options.output / side / name), image, png)
                    depth_16 = np.clip(np.rint(depth * 256), 0, 65535).astype(np.uint16)
                    cv2.imwrite(str(options.output / "depth" / name), depth_16, png)
                    offset_16 = np.where(depth > 0, np.rint(offset / 1000) + 32768, 0).astype(np.uint16)
                    cv2.imwrite(str(options.output / "offset" / name), offset_16, png)
                maps += 1

        for topic, (_, data, *_), _ in bag.read_messages(list(topics), raw=True):
            what = topics[topic]
            if what == "lidar":
                window.add(data)
                finish_frames(window.until_ns)
                continue
            t_ns, _ = header(data)
            pair = waiting.setdefault(t_ns, {})
            pair[what] = data, topic.endswith("/compressed")
            if len(pair) == 2:
                if seen % options.every == 0:
                    frames.append((t_ns, pair))
                seen += 1
                del waiting[t_ns]
        finish_frames(np.iinfo(np.int64).max)
    print(json.dumps({"maps": maps, "seconds": time.perf_counter() - begin}))


if __name__ == "__main__":
    main()
