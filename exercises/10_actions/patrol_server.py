"""An action server that patrols: it drives the robot from waypoint to waypoint."""

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from patrol_interfaces.action import Patrol
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class PatrolServer(Node):
    """Offers the action /patrol, hears /odom, and publishes velocity commands on /cmd_vel."""

    def __init__(self):
        super().__init__("patrol_server")
        self.declare_parameter("max_speed", 0.5)
        group = ReentrantCallbackGroup()
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Odometry, "/odom", self.on_odometry, 10, callback_group=group)
        self.server = ActionServer(
            self,
            Patrol,
            "patrol",
            self.execute,
            goal_callback=self.on_goal,
            cancel_callback=self.on_cancel,
            callback_group=group,
        )

    def on_odometry(self, message):
        # Your part: keep where the robot is, and its heading.
        pass

    def on_goal(self, goal):
        # Your part: accept what can be done, one goal at a time.
        return GoalResponse.REJECT

    def on_cancel(self, goal_handle):
        # Your part: a patrol can be cancelled.
        return CancelResponse.REJECT

    def execute(self, goal_handle):
        # Your part: drive, publish feedback, stop when cancelled, and return a result.
        return Patrol.Result()


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(4)
    executor.add_node(PatrolServer())
    executor.spin()


if __name__ == "__main__":
    main()
