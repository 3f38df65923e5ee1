"""List the models of a running world and look at one: `gz model --list`, `gz model -m robot -p`, `-s lidar`.

Models come from the service `/world/W/scene/info`, poses from the topic `/world/W/pose/info`, both of SceneBroadcaster.

Source: https://gazebosim.org/api/sim/8/model_command.html
"""

from __future__ import annotations

import argparse
import math
import threading
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.command_line import Parser
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.transport.node import Node

_TIMEOUT_MS = 5000


def add_arguments(parser: Parser) -> None:
    parser.add_argument("--list", action="store_true", help="the names of all models")
    parser.add_argument("-m", "--model", metavar="NAME", help="the model to look at")
    parser.add_argument("-p", "--pose", action="store_true", help="its pose only: position (m), roll pitch yaw (rad)")
    parser.add_argument("-l", "--link", metavar="NAME", nargs="?", const="", help="its links, or one of them")
    parser.add_argument("-j", "--joint", metavar="NAME", nargs="?", const="", help="its joints, or one of them")
    parser.add_argument("-s", "--sensor", metavar="NAME", nargs="?", const="", help="its sensors, or one of them")
    parser.commands("--list", "--model")
    for option in ("--pose", "--link", "--joint", "--sensor"):
        parser.needs(option, "--model")


def run(values: argparse.Namespace) -> int:
    """Run `gz model`; return the exit code. Raises ValueError with one sentence if there is no world or model."""
    with Node() as node:
        world = _world(node)
        scene = _scene(node, world)
        if values.list:
            print("Available models:")
            for model in scene.model:
                print(f"    - {model.name}")
            return 0
        model = _named(scene.model, values.model, f"world '{world}' has no model")
        pose = _pose_now(node, world, model)
        if values.pose:
            print(f"{_position(pose)}\n{_angles(pose)}")
            return 0
        _print_model(model, pose, values)
    return 0


def _world(node: Node) -> str:
    from gz_course.sim.gz.msgs.empty_pb2 import Empty
    from gz_course.sim.gz.msgs.stringmsg_v_pb2 import StringMsg_V

    done, worlds = node.request("/gazebo/worlds", None, Empty, StringMsg_V, _TIMEOUT_MS)
    if not done or not worlds.data:
        raise ValueError("no running world answers; start one with gz sim, in the same GZ_PARTITION")
    return str(worlds.data[0])


def _scene(node: Node, world: str) -> Any:
    from gz_course.sim.gz.msgs.empty_pb2 import Empty
    from gz_course.sim.gz.msgs.scene_pb2 import Scene

    done, scene = node.request(valid_topic(f"/world/{world}/scene/info"), None, Empty, Scene, _TIMEOUT_MS)
    if not done:
        raise ValueError(f"world '{world}' does not publish its scene; it needs the SceneBroadcaster system")
    return scene


def _named(parts: Any, name: str, sentence: str) -> Any:
    found = next((each for each in parts if each.name == name), None)
    if found is None:
        raise ValueError(f"{sentence} '{name}'{did_you_mean(name, [each.name for each in parts])}")
    return found


def _pose_now(node: Node, world: str, model: Any) -> Any:
    """Return the present pose of a model, or that in the scene if no poses arrive."""
    from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V

    heard = threading.Event()
    found: list[Any] = []

    def take(message: Any) -> None:
        found.extend(each for each in message.pose if each.id == model.id)
        heard.set()

    node.subscribe(Pose_V, valid_topic(f"/world/{world}/pose/info"), take)
    heard.wait(_TIMEOUT_MS / 1000)
    return found[0] if found else model.pose


def _print_model(model: Any, pose: Any, values: argparse.Namespace) -> None:
    print(f"Model: [{model.id}]\n  - Name: {model.name}")
    print(f"  - Pose [ XYZ (m) ] [ RPY (rad) ]:\n    {_position(pose)}\n    {_angles(pose)}")
    everything = values.link is None and values.joint is None and values.sensor is None
    if values.link is not None or everything:
        links = model.link if not values.link else [_named(model.link, values.link, "it has no link")]
        for link in links:
            print(f"  - Link [{link.id}]\n    - Name: {link.name}\n    - Parent: {model.name} [{model.id}]")
            print(f"    - Pose [ XYZ (m) ] [ RPY (rad) ]:\n      {_position(link.pose)}\n      {_angles(link.pose)}")
    if values.sensor is not None or everything:
        _print_sensors(model, values.sensor or "")
    if values.joint is not None or everything:
        joints = model.joint if not values.joint else [_named(model.joint, values.joint, "it has no joint")]
        for joint in joints:
            print(
                f"  - Joint [{joint.id}]\n    - Name: {joint.name}\n    - Type: {joint.Type.Name(joint.type).lower()}"
            )
            print(f"    - Parent Link: {joint.parent}\n    - Child Link: {joint.child}")


def _print_sensors(model: Any, name: str) -> None:
    found = [(link, sensor) for link in model.link for sensor in link.sensor]
    if name:
        wanted = _named([sensor for _, sensor in found], name, "it has no sensor")
        found = [(link, sensor) for link, sensor in found if sensor is wanted]
    for link, sensor in found:
        print(f"  - Sensor [{sensor.id}]\n    - Name: {sensor.name}\n    - Parent: {link.name} [{link.id}]")
        print(f"    - Pose [ XYZ (m) ] [ RPY (rad) ]:\n      {_position(sensor.pose)}\n      {_angles(sensor.pose)}")
        print(f"    - Type: {sensor.type}\n    - Update rate (Hz): {sensor.update_rate:g}\n    - Topic: {sensor.topic}")
        if sensor.HasField("camera"):
            camera = sensor.camera
            print(f"    - Horizontal field of view (rad): {camera.horizontal_fov:g}")
            print(f"    - Image width (px): {camera.image_size.x:g}\n    - Image height (px): {camera.image_size.y:g}")
            print(f"    - Near clip (m): {camera.near_clip:g}\n    - Far clip (m): {camera.far_clip:g}")


def _position(pose: Any) -> str:
    return f"[{pose.position.x:.6f} {pose.position.y:.6f} {pose.position.z:.6f}]"


def _angles(pose: Any) -> str:
    w, x, y, z = pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z
    sine = max(-1.0, min(1.0, 2.0 * (w * y - z * x)))
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return f"[{roll:.6f} {math.asin(sine):.6f} {yaw:.6f}]"
