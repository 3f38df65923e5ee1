"""No loop: a timer steps a state machine, and execute waits for a future. Coroutine, single-threaded."""

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from patrol_interfaces.action import Patrol
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.node import Node
from rclpy.task import Future


class Patroller(Node):
    def __init__(self):
        super().__init__("patroller")
        self.declare_parameter("max_speed", 0.5)
        self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Odometry, "/odom", self.step, 10)
        self.active = None
        self.taken = False
        self.said = self.get_clock().now()
        self.server = ActionServer(
            self,
            Patrol,
            "/patrol",
            self.execute,
            goal_callback=self.check,
            handle_accepted_callback=lambda handle: handle.execute(),
            cancel_callback=lambda handle: CancelResponse.ACCEPT,
        )

    def check(self, goal):
        possible = len(goal.waypoints) > 0 and 0.0 < goal.speed <= self.get_parameter("max_speed").value
        if self.taken or not possible:
            return GoalResponse.REJECT
        self.taken = True
        return GoalResponse.ACCEPT

    async def execute(self, handle):
        self.result, self.over, self.active = Patrol.Result(), Future(), handle
        await self.over
        self.active, self.taken = None, False
        return self.result

    def step(self, message):
        handle = self.active
        if handle is None or self.over.done():
            return
        if handle.is_cancel_requested:
            self.finish(handle.canceled)
            return
        position, q = message.pose.pose.position, message.pose.pose.orientation
        target = handle.request.waypoints[self.result.visited]
        east, north = target.x - position.x, target.y - position.y
        left = math.hypot(east, north)
        if left < 0.1:
            self.result.visited += 1
            if self.result.visited == len(handle.request.waypoints):
                self.finish(handle.succeed)
            return
        error = math.remainder(math.atan2(north, east) - 2 * math.atan2(q.z, q.w), 2 * math.pi)
        command = Twist()
        command.angular.z = max(-1.2, min(1.2, 3 * error))
        command.linear.x = handle.request.speed if abs(error) < 0.2 else 0.0
        self.commands.publish(command)
        now = self.get_clock().now()
        if (now - self.said).nanoseconds > 4e8:
            self.said = now
            handle.publish_feedback(Patrol.Feedback(waypoint=self.result.visited, distance=left))

    def finish(self, how):
        self.commands.publish(Twist())
        how()
        self.over.set_result(None)


def main():
    rclpy.init()
    rclpy.spin(Patroller())


if __name__ == "__main__":
    main()
