"""An action server that patrols: it drives the robot from waypoint to waypoint."""

import threading
from math import atan2, hypot, remainder, tau

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from patrol_interfaces.action import Patrol
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node

REACHED = 0.1  # [m]
FEEDBACK = 0.2  # [s]


class PatrolServer(Node):
    """Offers the action /patrol, hears /odom, and publishes velocity commands on /cmd_vel."""

    def __init__(self):
        super().__init__("patrol_server")
        self.declare_parameter("max_speed", 0.5)
        group = ReentrantCallbackGroup()
        self.news = threading.Condition()
        self.pose = None
        self.busy = False
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
        p, q = message.pose.pose.position, message.pose.pose.orientation
        with self.news:
            self.pose = p.x, p.y, 2 * atan2(q.z, q.w)
            self.news.notify_all()

    def on_goal(self, goal):
        limit = self.get_parameter("max_speed").value
        with self.news:
            if self.busy or not goal.waypoints or not 0 < goal.speed <= limit:
                return GoalResponse.REJECT
            self.busy = True
        return GoalResponse.ACCEPT

    def on_cancel(self, goal_handle):
        return CancelResponse.ACCEPT

    def command(self, ahead=0.0, left=0.0):
        twist = Twist()
        twist.linear.x = float(ahead)
        twist.angular.z = float(left)
        self.publisher.publish(twist)

    def next_pose(self):
        """Waits for the next odometry; None after a second without."""
        with self.news:
            return self.pose if self.news.wait(timeout=1.0) else None

    def execute(self, goal_handle):
        visited = 0
        try:
            for index, waypoint in enumerate(goal_handle.request.waypoints):
                if not self.drive_to(goal_handle, index, waypoint):
                    goal_handle.canceled()
                    return Patrol.Result(visited=visited)
                visited += 1
            self.command()
            goal_handle.succeed()
            return Patrol.Result(visited=visited)
        finally:
            self.command()
            self.busy = False

    def drive_to(self, goal_handle, index, waypoint):
        """True when the waypoint is reached, False if the patrol is cancelled."""
        speed = goal_handle.request.speed
        told = None
        while rclpy.ok():
            pose = self.next_pose()
            if goal_handle.is_cancel_requested:
                self.command()
                return False
            if pose is None:
                continue
            x, y, heading = pose
            dx, dy = waypoint.x - x, waypoint.y - y
            distance = hypot(dx, dy)
            now = self.get_clock().now().nanoseconds / 1e9
            if told is None or now - told >= FEEDBACK:
                told = now
                goal_handle.publish_feedback(Patrol.Feedback(waypoint=index, distance=distance))
            if distance < REACHED:
                return True
            turn = remainder(atan2(dy, dx) - heading, tau)
            left = max(-1.5, min(1.5, 3.0 * turn))
            if abs(turn) > 0.35:
                self.command(0.0, left)
            else:
                self.command(min(speed, max(0.1, 1.5 * distance)), left)
        return False


def main():
    rclpy.init()
    executor = MultiThreadedExecutor(4)
    executor.add_node(PatrolServer())
    executor.spin()


if __name__ == "__main__":
    main()
