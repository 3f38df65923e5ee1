import time
from math import hypot

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy import callback_groups, executors
from rclpy.node import Node
from std_srvs.srv import Trigger


class Ahead(Node):
    """Offers /ahead: drives 0.3 m by odometry, and answers when it is there."""

    def __init__(self):
        super().__init__("ahead")
        self.place = None
        group = callback_groups.ReentrantCallbackGroup()
        self.publisher = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Odometry, "/odom", self.on_odometry, 10, callback_group=group)
        self.create_service(Trigger, "/ahead", self.on_ahead, callback_group=group)
        print("ready", flush=True)

    def on_odometry(self, message):
        self.place = message.pose.pose.position.x, message.pose.pose.position.y

    def on_ahead(self, request, response):
        while self.place is None:
            time.sleep(0.05)
        start, command = self.place, Twist()
        command.linear.x = 0.2
        while hypot(self.place[0] - start[0], self.place[1] - start[1]) < 0.3:
            self.publisher.publish(command)
            time.sleep(0.05)
        self.publisher.publish(Twist())
        response.success = True
        return response


rclpy.init()
executor = executors.MultiThreadedExecutor(2)
executor.add_node(Ahead())
executor.spin()
