"""A drive whose plan is a frozen dataclass, and which is computed by a pure function."""

from dataclasses import dataclass

import rclpy
from geometry_msgs.msg import Twist, Vector3
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time


@dataclass(frozen=True)
class Plan:
    forward: float
    turn: float
    lasting: Duration

    def at(self, passed: Duration) -> Twist:
        if passed < self.lasting:
            return Twist(linear=Vector3(x=self.forward), angular=Vector3(z=self.turn))
        return Twist()


class Executor(Node):
    def __init__(self, plan: Plan) -> None:
        super().__init__("plan_executor")
        self._plan = plan
        self._begin: Time | None = None
        self._publisher = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_timer(0.1, self._send)

    def _send(self) -> None:
        now = self.get_clock().now()
        self._begin = self._begin or now
        self._publisher.publish(self._plan.at(now - self._begin))


def main() -> None:
    rclpy.init()
    rclpy.spin(Executor(Plan(0.5, 0.1, Duration(seconds=5))))


if __name__ == "__main__":
    main()
