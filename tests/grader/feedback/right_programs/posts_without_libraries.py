#!/usr/bin/env python3
# Red posts, without cv_bridge and message_filters: pictures are numpy arrays, pairs are found by their stamps.
from __future__ import annotations

import math

import numpy as np
import rclpy
from geometry_msgs.msg import PointStamped, Twist
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CameraInfo, Image, Imu
from std_msgs.msg import Int32

LOSSY = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
STAND_S = 1.0
OFFSET_M = 0.12


def key(header) -> int:
    return header.stamp.sec * 10**9 + header.stamp.nanosec


class Gyro:
    """Adds up turning rates, less the bias of the time in which the robot stands."""

    def __init__(self):
        self.t0 = self.t = None
        self.sum = self.n = 0
        self.yaw = None
        self.log: list[tuple[int, float]] = []

    def add(self, t: int, rate: float) -> None:
        self.t0 = t if self.t0 is None else self.t0
        if (t - self.t0) / 1e9 < STAND_S - 0.04:
            self.sum, self.n = self.sum + rate, self.n + 1
            self.log.append((t, 0.0))
        else:
            if self.yaw is None:
                self.yaw = 0.0
            self.yaw += (rate - self.sum / self.n) * (t - self.t) / 1e9
            self.log.append((t, self.yaw))
        self.t = t

    def at(self, t: int) -> float:
        if not self.log:
            return 0.0
        times, yaws = zip(*self.log[-100:])
        return float(np.interp(t, times, yaws))


def red_mask(image: Image) -> np.ndarray:
    rows = np.frombuffer(bytes(image.data), np.uint8).reshape(image.height, image.step)
    rgb = rows[:, : 3 * image.width].reshape(image.height, image.width, 3).astype(float)
    r, g, b = rgb[..., 0], rgb[..., 1], rgb[..., 2]
    return (r > 60) & (r > 2.2 * np.maximum(g, b))


def depth_array(depth: Image) -> np.ndarray:
    rows = np.frombuffer(bytes(depth.data), np.uint8).reshape(depth.height, depth.step)
    kind = np.dtype(np.float32).newbyteorder(">" if depth.is_bigendian else "<")
    return np.ascontiguousarray(rows[:, : 4 * depth.width]).view(kind)


class RedPostFinder(Node):
    def __init__(self):
        super().__init__("red_posts")
        self.gyro = Gyro()
        self.k = None
        self.colour: dict[int, Image] = {}
        self.depth: dict[int, Image] = {}
        self.current: list[tuple[float, float]] = []
        self.map: list[list[float]] = []  # x, y, number of sightings
        self.goal = None
        self.step = self.turn
        self.cmd = self.create_publisher(Twist, "/cmd_vel", 10)
        self.pub_post = self.create_publisher(PointStamped, "/red_post", 20)
        self.pub_count = self.create_publisher(Int32, "/red_count", 1)
        self.create_subscription(Imu, "/imu", lambda m: self.gyro.add(key(m.header), m.angular_velocity.z), 50)
        self.create_subscription(CameraInfo, "/camera/camera_info", self.on_info, 5)
        self.create_subscription(Image, "/camera/image", lambda m: self.on_image(self.colour, m), LOSSY)
        self.create_subscription(Image, "/depth/image", lambda m: self.on_image(self.depth, m), LOSSY)
        self.create_timer(0.1, self.tick)

    def on_info(self, info):
        self.k = info.k

    def on_image(self, store, message):
        store[key(message.header)] = message
        for t in sorted(self.colour.keys() & self.depth.keys()):
            self.on_pair(t, self.colour[t], self.depth[t])
            for d in (self.colour, self.depth):
                for old in [k for k in d if k <= t]:
                    del d[old]

    def on_pair(self, t, colour, depth):
        if self.k is None:
            return
        fx, cx = self.k[0], self.k[2]
        z = depth_array(depth)
        mask = red_mask(colour) & np.isfinite(z) & (z > 0.05)
        count = mask.sum(axis=0)
        z_of_column = np.array([np.median(z[mask[:, c], c]) if count[c] > 3 else np.nan for c in range(mask.shape[1])])
        # a post ends where the red ends, or where its depth jumps
        change = np.abs(np.diff(z_of_column)) > 0.25
        ends = np.isnan(z_of_column[:-1]) | np.isnan(z_of_column[1:]) | change
        self.current = []
        for part in np.split(np.arange(mask.shape[1]), np.flatnonzero(ends) + 1):
            if len(part) < 3 or np.isnan(z_of_column[part]).any():
                continue
            ahead = float(np.median(z_of_column[part]))
            self.current.append((ahead, float(cx - part.mean()) / fx * ahead))
        for ahead, left in self.current:
            message = PointStamped()
            message.header = colour.header
            message.header.frame_id = "camera_link"
            message.point.x = ahead
            message.point.y = left
            self.pub_post.publish(message)
            if self.goal is None:
                self.learn(ahead + OFFSET_M, left, self.gyro.at(t))

    def learn(self, ahead, left, yaw):
        place = complex(ahead, left) * complex(math.cos(yaw), math.sin(yaw))
        for post in self.map:
            if abs(complex(post[0], post[1]) - place) < 0.55:
                post[2] += 1
                return
        self.map.append([place.real, place.imag, 1])

    # -- driving --------------------------------------------------------------------------------------------------
    def tick(self):
        if self.gyro.yaw is not None:
            twist = Twist()
            self.step(twist)
            self.cmd.publish(twist)

    def turn(self, twist):
        left = 2 * math.pi - self.gyro.yaw
        if left > 0.02:
            twist.angular.z = min(0.8, 0.1 + 2.0 * left)
            return
        self.pub_count.publish(Int32(data=len(self.map)))
        self.goal = min(self.map, key=lambda p: math.hypot(p[0], p[1]), default=None)
        self.step = self.approach

    def approach(self, twist):
        if self.goal is None:
            return
        error = math.remainder(math.atan2(self.goal[1], self.goal[0]) - self.gyro.yaw, 2 * math.pi)
        bearing = lambda p: math.atan2(p[1], p[0])  # noqa: E731
        mine = [p for p in self.current if abs(bearing(p) - error) < 0.35]
        if abs(error) > 0.3 or not mine:
            twist.angular.z = max(-0.8, min(0.8, 2 * error))
            return
        post = min(mine, key=lambda p: abs(bearing(p) - error))
        twist.angular.z = bearing(post)
        twist.linear.x = max(-0.1, min(0.3, post[0] - 1.0))


def main():
    rclpy.init()
    rclpy.spin(RedPostFinder())


if __name__ == "__main__":
    main()
