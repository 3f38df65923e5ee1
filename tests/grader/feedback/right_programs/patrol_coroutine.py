#!/usr/bin/env python3
"""Patrol server with coroutines: one thread, no locks. execute() awaits the next odometry."""

import math

import rclpy
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from patrol_interfaces.action import Patrol
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.node import Node
from rclpy.task import Future


class PatrolServer(Node):
    def __init__(self):
        super().__init__("patrol_server")
        self.declare_parameter("max_speed", 0.5)
        self.waiter = None  # a Future that gets the next pose
        self.patrolling = False
        self.cmd = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.odom_cb, 50)
        self.action = ActionServer(
            self,
            Patrol,
            "/patrol",
            execute_callback=self.execute_cb,
            goal_callback=self.goal_cb,
            cancel_callback=lambda _handle: CancelResponse.ACCEPT,
        )

    # ---- callbacks ----
    def odom_cb(self, odom: Odometry):
        if self.waiter is not None and not self.waiter.done():
            self.waiter.set_result(odom.pose.pose)

    def goal_cb(self, goal: Patrol.Goal):
        max_speed = self.get_parameter("max_speed").get_parameter_value().double_value
        ok = len(goal.waypoints) > 0 and goal.speed > 0.0 and goal.speed <= max_speed and not self.patrolling
        if ok:
            self.patrolling = True
        return GoalResponse.ACCEPT if ok else GoalResponse.REJECT

    async def execute_cb(self, handle):
        result = Patrol.Result()
        goal = handle.request
        last_feedback = -math.inf
        while result.visited < len(goal.waypoints):
            self.waiter = Future(executor=self.executor)
            pose = await self.waiter
            if handle.is_cancel_requested:
                self.drive(0.0, 0.0)
                self.patrolling = False
                handle.canceled()
                return result
            target = goal.waypoints[result.visited]
            east, north = target.x - pose.position.x, target.y - pose.position.y
            distance = math.hypot(east, north)
            now = self.get_clock().now().nanoseconds * 1e-9
            if now - last_feedback > 0.25:
                last_feedback = now
                handle.publish_feedback(Patrol.Feedback(waypoint=result.visited, distance=distance))
            if distance < 0.09:
                result.visited += 1
                last_feedback = -math.inf  # say at once where it goes next
                continue
            q = pose.orientation
            yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
            error = math.atan2(north, east) - yaw
            error = math.atan2(math.sin(error), math.cos(error))
            ahead = goal.speed * max(0.0, math.cos(error)) ** 8 if abs(error) < 0.6 else 0.0
            self.drive(min(ahead, max(0.12, 2 * distance)), max(-1.4, min(1.4, 2.5 * error)))
        self.drive(0.0, 0.0)
        self.patrolling = False
        handle.succeed()
        return result

    def drive(self, ahead, turn):
        self.cmd.publish(Twist(linear=Vector3(x=ahead), angular=Vector3(z=turn)))


def main():
    rclpy.init()
    node = PatrolServer()
    rclpy.spin(node)


if __name__ == "__main__":
    main()
