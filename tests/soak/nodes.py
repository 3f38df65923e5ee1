"""The three nodes of a long run: `python -m gz_course.tests.soak.nodes NODE WORLD`.

`listener` subscribes to every topic, `commander` publishes commands from a timer of simulated time and logs, `builder`
creates a box and removes it, again and again. Each prints a line with what it has done when it is interrupted.
"""

import contextlib
import importlib
import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy._rclpy_pybind11 import RCLError  # what `spin` may raise if the context ends between two waits
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from ros_gz_interfaces.srv import DeleteEntity, SpawnEntity

NODES = ("listener", "commander", "builder")
BOX = """<sdf version='1.10'><model name='made'><pose>3 3 1 0 0 0</pose><link name='l'><collision name='c'><geometry>
<box><size>.2 .2 .2</size></box></geometry></collision><visual name='v'><geometry><box><size>.2 .2 .2</size></box>
</geometry></visual></link></model></sdf>"""
LOOK, COMMAND, BUILD = 1.0, 0.1, 5.0  # [s] of simulated time


class Listener(Node):
    """Subscribes to what there is, and to what comes later."""

    def __init__(self) -> None:
        super().__init__("listener", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.heard, self.known = 0, set()
        self.timer = self.create_timer(LOOK, self.look)

    def look(self) -> None:
        for topic, types in self.get_topic_names_and_types():
            if topic not in self.known:
                self.known.add(topic)
                package, _, name = types[0].split("/")
                kind = getattr(importlib.import_module(f"{package}.msg"), name)
                self.create_subscription(kind, topic, self.hear, qos_profile_sensor_data)

    def hear(self, _) -> None:
        self.heard += 1

    def done(self) -> str:
        return f"listener: {self.heard} messages on {len(self.known)} topics"


class Commander(Node):
    """Publishes and logs."""

    def __init__(self) -> None:
        super().__init__("commander", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.sent = 0
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.timer = self.create_timer(COMMAND, self.command)

    def command(self) -> None:
        command = Twist()
        command.linear.x, command.angular.z = 0.2, 0.3 * (-1) ** (self.sent // 50)
        self.publisher.publish(command)
        self.sent += 1
        self.get_logger().debug(f"command {self.sent}")

    def done(self) -> str:
        return f"commander: {self.sent} commands"


class Builder(Node):
    """Creates a model, removes it, and so on; each step waits for the answer of the one before."""

    def __init__(self, world: str) -> None:
        super().__init__("builder", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.built, self.refused, self.stands, self.asked = 0, 0, False, None
        self.create, self.remove = (
            self.create_client(SpawnEntity, f"/world/{world}/create"),
            self.create_client(DeleteEntity, f"/world/{world}/remove"),
        )
        self.timer = self.create_timer(BUILD, self.build)

    def build(self) -> None:
        client = self.remove if self.stands else self.create
        if (self.asked is not None and not self.asked.done()) or not client.service_is_ready():
            return
        request = client.srv_type.Request()
        if self.stands:
            request.entity.name, request.entity.type = "made", request.entity.MODEL
        else:
            request.entity_factory.sdf = BOX
        self.asked = client.call_async(request)
        self.asked.add_done_callback(self.answered)

    def answered(self, future) -> None:
        if future.result().success:
            self.stands = not self.stands
            self.built += self.stands
        else:
            self.refused += 1

    def done(self) -> str:
        return f"builder: {self.built} boxes built, {self.refused} requests refused"


def main() -> None:
    name, world = sys.argv[1:]
    rclpy.init(args=[])
    node = {"listener": Listener, "commander": Commander}[name]() if name != "builder" else Builder(world)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException, RCLError):
        rclpy.spin(node)
    print(node.done(), flush=True)
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
