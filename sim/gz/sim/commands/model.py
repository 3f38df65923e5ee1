"""List the models of a running world and look at one: `gz model --list`, `gz model -m robot -p`, `-s lidar`.

Models come from the service `/world/W/scene/info`, poses from the topic `/world/W/pose/info`, both of SceneBroadcaster.

Source: https://gazebosim.org/api/sim/8/model_command.html
"""

from __future__ import annotations

import argparse
import threading
from collections.abc import Iterator
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.command_line import Parser
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.transport.node import Node

_TIMEOUT_MS = 5000


def add_arguments(parser: Parser) -> None:
    parser.add_argument("--list", action="store_true", help="the names of all models")
    parser.add_argument("-m", "--model", metavar="NAME", help="the model to look at")
    parser.add_argument("-p", "--pose", action="store_true", help="its pose: position (m), roll pitch yaw (rad)")
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
        print(f"\nRequesting state for world [{world}]...\n")
        scene = _scene(node, world)
        if values.list:
            print("Available models:")
            for model in scene.model:
                print(f"    - {model.name}")
            return 0
        model = _named(scene.model, values.model, f"world '{world}' has no model")
        for line in _lines(model, _pose_now(node, world, model), values):
            print(line)
    return 0


def _lines(model: Any, pose: Any, values: argparse.Namespace) -> Iterator[str]:
    """Yield what the options ask for; everything without any."""
    from gz_course.sim.gz.sim.scene import text

    link, joint, sensor = values.link, values.joint, values.sensor
    everything = not values.pose and link is None and joint is None and sensor is None
    pad = ""
    if everything or values.pose:
        yield from text.model_lines(model, pose)
        pad = "  "
    if everything or link is not None:
        links = [_named(model.link, link, "it has no link")] if link else model.link
        yield from (pad + line for line in text.link_lines(model, links))
    if sensor is not None:
        sensors = [each for part in model.link for each in part.sensor]
        found = [_named(sensors, sensor, "it has no sensor")] if sensor else sensors
        yield from (pad + line for line in text.sensor_lines(model, found))
    if everything or joint is not None:
        joints = [_named(model.joint, joint, "it has no joint")] if joint else model.joint
        yield from (pad + line for line in text.joint_lines(model, joints))


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
