"""An action server that patrols: it drives the robot from waypoint to waypoint, by odometry."""

import time
from math import atan2, hypot, pi

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from patrol_interfaces.action import Patrol
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node

NEAR = 0.05  # [m]


class PatrolServer(Node):
    def __init__(self):
        super().__init__("patrol_server")
        self.declare_parameter("max_speed", 0.5)
        self.x = self.y = self.heading = 0.0
        self.busy = False
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
        pose = message.pose.pose
        self.x, self.y = pose.position.x, pose.position.y
        self.heading = 2 * atan2(pose.orientation.z, pose.orientation.w)

    def on_goal(self, goal):
        fastest = self.get_parameter("max_speed").value
        if self.busy or not goal.waypoints or not 0 < goal.speed <= fastest:
            return GoalResponse.REJECT
        self.busy = True
        return GoalResponse.ACCEPT

    def on_cancel(self, goal_handle):
        return CancelResponse.ACCEPT

    def execute(self, goal_handle):
        result = Patrol.Result()
        goal = goal_handle.request
        for index, waypoint in enumerate(goal.waypoints):
            while (left := hypot(waypoint.x - self.x, waypoint.y - self.y)) > NEAR:
                if goal_handle.is_cancel_requested:
                    self.publisher.publish(Twist())
                    self.busy = False
                    goal_handle.canceled()
                    return result
                self.publisher.publish(self.command(waypoint, left, goal.speed))
                goal_handle.publish_feedback(Patrol.Feedback(waypoint=index, distance=left))
                time.sleep(0.1)
            result.visited += 1
        self.publisher.publish(Twist())
        self.busy = False
        goal_handle.succeed()
        return result

    def command(self, waypoint, left, speed):
        turn = atan2(waypoint.y - self.y, waypoint.x - self.x) - self.heading
        turn = (turn + pi) % (2 * pi) - pi
        command = Twist()
        command.angular.z = max(-1.0, min(1.0, 2.0 * turn))
        if abs(turn) < 0.3:
            command.linear.x = min(0.3, 1.5 * left)
        return command


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(4)
    executor.add_node(PatrolServer())
    executor.spin()


if __name__ == "__main__":
    main()
