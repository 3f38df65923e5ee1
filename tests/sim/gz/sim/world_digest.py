"""A program: drives the built-in robot for a while, spawns another, and prints a digest of every topic's bytes.

`python world_digest.py SEED`; run in several processes by the determinism test and benchmark.
"""

import hashlib
import json
import sys
from pathlib import Path

from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope


def digests(seed: int) -> dict[str, str]:
    found: dict[str, hashlib._Hash] = {}
    known: set[str] = set()

    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        world = World.load("lidar_room.sdf", seed=seed, node=node)

        def listen() -> None:
            for topic in node.topic_list():
                if topic not in known:
                    known.add(topic)
                    found[topic] = hashlib.sha256()
                    node.subscribe_raw(topic, lambda data, info: found[info.topic].update(data))

        def drive(name: str, ticks: int) -> None:
            publisher = node.advertise(f"/model/{name}/cmd_vel", Twist)
            for tick in range(ticks):
                command = Twist()
                command.linear.x, command.angular.z = 0.5 - tick * 0.002, (tick % 7) * 0.1
                publisher.publish(command)
                world.step(10)
            publisher.close()

        listen()
        first = world.truth.model_names()[0]
        drive(first, 20)
        text = (BUILT_IN_MODELS / Path("two_wheel_robot") / "model.sdf").read_text()
        world.editor.spawn(text, name="second", pose=Pose((1.0, -2.0, 0.0)))
        listen()
        drive("second", 15)
        world.editor.set_pose(first, Pose((-2.0, 1.0, 0.0)))
        drive(first, 15)
        world.editor.remove("second")
        drive(first, 10)
        found["state"] = hashlib.sha256(world.data.qpos.tobytes() + world.data.qvel.tobytes())
        world.close()
    return {topic: digest.hexdigest() for topic, digest in sorted(found.items())}


if __name__ == "__main__":
    json.dump(digests(int(sys.argv[1])), sys.stdout)
