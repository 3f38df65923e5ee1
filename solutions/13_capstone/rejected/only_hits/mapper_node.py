"""Draws the hits, and never what is free."""

from math import atan2, cos, floor, hypot, pi, remainder, sin

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

RESOLUTION = 0.1  # [m] side of a cell
WIDTH, HEIGHT = 100, 80  # [cells] along x and along y
LEFT, BOTTOM = -5.0, -4.0  # [m] the corner of the cell (0, 0) in odom
KEEP = 0.4  # [m] between the robot's middle and what is ahead
BESIDE = 0.3  # [m] on both sides of the way must be free
STEP = 1.2  # [m] at most to the next place
SPEED, TURN = 0.5, 1.3  # [m/s], [rad/s]


class Mapper(Node):
    def __init__(self):
        super().__init__("wanderer")
        self.maps = self.create_publisher(OccupancyGrid, "map", 1)
        self.commands = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_subscription(Odometry, "odom", self.on_odom, 1)
        self.create_subscription(LaserScan, "scan", self.on_scan, 1)
        self.timer = self.create_timer(0.5, self.publish_map)
        self.pose = self.goal = None
        self.hits = [0] * (WIDTH * HEIGHT)
        self.passes = [0] * (WIDTH * HEIGHT)
        self.been = {}  # how often the robot was in each square of 0.5 m

    def on_odom(self, message):
        q = message.pose.pose.orientation
        self.pose = message.pose.pose.position.x, message.pose.pose.position.y, 2 * atan2(q.z, q.w)

    def on_scan(self, scan):
        if self.pose is None:
            return
        self.draw(scan)
        self.drive(scan)

    def draw(self, scan):
        """Count the hits and the passes of one scan."""
        x, y, heading = self.pose
        for number, distance in enumerate(scan.ranges):
            angle = heading + scan.angle_min + number * scan.angle_increment
            hit = scan.range_min < distance < scan.range_max
            end = distance if hit else scan.range_max
            way = 0.0
            while way < end - 0.1:
                self.count(self.passes, x + way * cos(angle), y + way * sin(angle))
                way += 0.1
            if hit:
                self.count(self.hits, x + distance * cos(angle), y + distance * sin(angle))

    def count(self, counts, x, y):
        column, row = floor((x - LEFT) / RESOLUTION), floor((y - BOTTOM) / RESOLUTION)
        if 0 <= column < WIDTH and 0 <= row < HEIGHT:
            counts[row * WIDTH + column] += 1

    def publish_map(self):
        message = OccupancyGrid()
        message.header.frame_id = "odom"
        message.header.stamp = self.get_clock().now().to_msg()
        message.info.resolution, message.info.width, message.info.height = RESOLUTION, WIDTH, HEIGHT
        message.info.origin.position.x, message.info.origin.position.y = LEFT, BOTTOM
        message.info.origin.orientation.w = 1.0
        message.data = [self.value(h, p) for h, p in zip(self.hits, self.passes, strict=True)]
        self.maps.publish(message)

    def value(self, hits, passes):
        """Return 100 for a hit, -1 for all else."""
        return 100 if hits else -1

    def drive(self, scan):
        x, y, heading = self.pose
        square = round(x / 0.5), round(y / 0.5)
        self.been[square] = self.been.get(square, 0) + 1
        ranges = np.minimum(np.array(scan.ranges), scan.range_max)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))

        def clear(direction):
            """Return how far the robot can go in a direction [m]."""
            ahead, beside = ranges * np.cos(angles - direction), ranges * np.sin(angles - direction)
            return np.min(ahead[(ahead > 0) & (np.abs(beside) < BESIDE)], initial=scan.range_max) - KEEP

        if self.goal is None or hypot(self.goal[0] - x, self.goal[1] - y) < 0.15:
            best = -1e9
            for direction in np.arange(-pi, pi, pi / 18):
                way = min(clear(direction), STEP)
                if way < 0.3:
                    continue
                place = x + way * cos(heading + direction), y + way * sin(heading + direction)
                visits = self.been.get((round(place[0] / 0.5), round(place[1] / 0.5)), 0)
                value = 0.5 * way - 0.3 * visits - 0.25 * abs(direction)
                if value > best:
                    best, self.goal = value, place
        command = Twist()
        if self.goal is not None:
            error = remainder(atan2(self.goal[1] - y, self.goal[0] - x) - heading, 2 * pi)
            if abs(error) < 0.5 and clear(error) < 0.0:
                square = round(self.goal[0] / 0.5), round(self.goal[1] / 0.5)
                self.been[square] = self.been.get(square, 0) + 3  # there is no way
                self.goal = None
            elif abs(error) < 0.5:
                command.linear.x = SPEED * (1 - abs(error) / 0.5)
            command.angular.z = max(-TURN, min(TURN, 2 * error))
        self.commands.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Mapper())


main()
