"""No cv_bridge, no message_filters: bytes and stamps by hand, one function for each step."""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import PointStamped, Twist
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CameraInfo, Image, Imu
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("by_hand")
commands = node.create_publisher(Twist, "cmd_vel", 1)
points = node.create_publisher(PointStamped, "red_post", 50)
counts = node.create_publisher(Int32, "red_count", 1)
best_effort = QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT)
rates, waiting, lens, sightings = [], {}, [], []
state = {"heading": 0.0, "last": None, "phase": "stand", "goal": None, "distance": None, "left": 0.0}


def seconds(stamp):
    return stamp.sec + stamp.nanosec * 1e-9


def rows(message, kind, channels):
    """The pixels of a message as an array; rows may be padded."""
    kind = np.dtype(kind)
    flat = np.frombuffer(message.data, np.uint8).reshape(message.height, message.step)
    flat = np.ascontiguousarray(flat[:, : message.width * channels * kind.itemsize])
    return flat.view(kind).reshape(message.height, message.width, channels)


def on_imu(message):
    now = seconds(message.header.stamp)
    if state["phase"] == "stand":
        rates.append(message.angular_velocity.z)
        if len(rates) >= 40:
            state["phase"] = "turn"
    else:
        state["heading"] += (message.angular_velocity.z - np.median(rates)) * (now - state["last"])
    state["last"] = now
    drive()


def on_picture(message, which):
    pair = waiting.setdefault(seconds(message.header.stamp), {})
    pair[which] = message
    if len(pair) == 2 and lens:
        waiting.clear()
        look(pair["image"], pair["depth"])


def look(image, depth):
    r, g, b = (rows(image, "u1", 3)[..., i].astype(float) for i in range(3))
    red = (r - np.maximum(g, b) > 0.5 * r) & (r > 40)
    distance = rows(depth, "<f4", 1)[..., 0]
    state["distance"] = None
    begin = None
    for column in range(image.width + 1):
        is_red = column < image.width and red[:, column].sum() > 4
        if is_red and begin is None:
            begin = column
        elif not is_red and begin is not None:
            found = distance[:, begin:column][red[:, begin:column]]
            post(image.header.stamp, (begin + column) / 2, float(np.percentile(found, 30)))
            begin = None


def post(stamp, column, ahead):
    left = (lens[1] - column) * ahead / lens[0]
    message = PointStamped()
    message.header.stamp = stamp
    message.header.frame_id = "camera_link"
    message.point.x, message.point.y = ahead, left
    points.publish(message)
    if state["phase"] in ("stand", "turn"):
        angle = state["heading"] + math.atan2(left, ahead + 0.12)
        sightings.append((angle % (2 * math.pi), math.hypot(ahead + 0.12, left)))
    elif state["distance"] is None or ahead < state["distance"]:
        state["distance"], state["left"] = ahead, left


def groups():
    """The sightings in groups of neighbouring angles."""
    found = []
    for angle, distance in sorted(sightings):
        if found and angle - found[-1][-1][0] < 0.2:
            found[-1].append((angle, distance))
        else:
            found.append([(angle, distance)])
    if len(found) > 1 and found[0][0][0] + 2 * math.pi - found[-1][-1][0] < 0.2:
        found[0] += [(angle - 2 * math.pi, distance) for angle, distance in found.pop()]
    return found


def drive():
    command = Twist()
    if state["phase"] == "turn":
        rest = math.radians(360) - state["heading"]
        command.angular.z = 0.8 if rest > 0.3 else 0.2
        if rest < 0.03:
            command.angular.z = 0.0
            found = groups()
            counts.publish(Int32(data=len(found)))
            nearest = min(found, key=lambda group: np.median([distance for _, distance in group]))
            state["goal"] = float(np.mean([angle for angle, _ in nearest]))
            state["phase"] = "face"
    elif state["phase"] == "face":
        error = math.remainder(state["goal"] - state["heading"], 2 * math.pi)
        command.angular.z = math.copysign(min(0.6, 0.1 + abs(error)), error)
        if abs(error) < 0.05:
            state["phase"], state["distance"] = "approach", None
    elif state["phase"] == "approach" and state["distance"] is not None:
        command.angular.z = 0.8 * math.atan2(state["left"], state["distance"])
        command.linear.x = 0.25 if state["distance"] > 1.2 else max(0.0, 0.6 * (state["distance"] - 0.98))
        if state["distance"] < 1.0:
            state["phase"], command = "stop", Twist()
    commands.publish(command)


def on_camera_info(message):
    lens[:] = [message.k[0], message.k[2]]


node.create_subscription(Imu, "imu", on_imu, 10)
node.create_subscription(CameraInfo, "camera/camera_info", on_camera_info, 1)
node.create_subscription(Image, "camera/image", lambda message: on_picture(message, "image"), best_effort)
node.create_subscription(Image, "depth/image", lambda message: on_picture(message, "depth"), best_effort)
rclpy.spin(node)
