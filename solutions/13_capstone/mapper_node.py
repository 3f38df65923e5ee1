"""Explore rooms that nobody has seen, and map them: drive to the nearest cell beside which something is unknown."""

from collections import deque
from math import atan2, hypot, pi, remainder

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import LaserScan

RESOLUTION = 0.1  # [m] side of a cell
WIDTH, HEIGHT = 100, 80  # [cells] along x and along y
LEFT, BOTTOM = -5.0, -4.0  # [m] the corner of the cell (0, 0) in odom
UNKNOWN, FREE, OCCUPIED = -1, 0, 100

HIT, PASS = 0.9, -0.4  # log odds of one observation
SURE = 4.0  # log odds never leave -SURE to SURE
AWAY = 3  # [cells] that the robot's middle keeps from walls
SPEED, TURN = 0.5, 1.2  # [m/s], [rad/s]


class Mapper(Node):
    """Hears /odom and /scan, publishes /map, and drives by /cmd_vel."""

    def __init__(self):
        super().__init__("mapper")
        self.maps = self.create_publisher(OccupancyGrid, "/map", 10)
        self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
        self.create_subscription(Odometry, "/odom", self.on_odom, 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
        self.create_timer(1.0, self.publish_map)
        self.create_timer(0.2, self.drive)
        self.poses = deque(maxlen=10)  # the last ones: (time [ns], x [m], y [m], heading [rad])
        self.odds = np.zeros((HEIGHT, WIDTH))  # log odds that a cell is occupied; row y, column x
        self.path = []  # the cells (row, column) to the next goal

    def on_odom(self, message):
        p, q = message.pose.pose.position, message.pose.pose.orientation
        heading = atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
        self.poses.append((Time.from_msg(message.header.stamp).nanoseconds, p.x, p.y, heading))

    def on_scan(self, scan):
        if not self.poses:
            return
        taken = Time.from_msg(scan.header.stamp).nanoseconds
        _, x, y, heading = min(self.poses, key=lambda pose: abs(pose[0] - taken))
        ranges = np.array(scan.ranges)
        angles = heading + scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        hit = (ranges > scan.range_min) & (ranges < scan.range_max)
        ends = np.where(np.isfinite(ranges), ranges, scan.range_max)
        # Points on every ray, half a cell apart, as far as it is free.
        along = np.arange(0, scan.range_max, RESOLUTION / 2)
        ray, step = np.nonzero(along[None, :] < ends[:, None] - RESOLUTION)
        passed = self.cells(x + along[step] * np.cos(angles[ray]), y + along[step] * np.sin(angles[ray]))
        walls = self.cells(x + ranges[hit] * np.cos(angles[hit]), y + ranges[hit] * np.sin(angles[hit]))
        observed = np.zeros_like(self.odds)
        observed[passed] = PASS
        observed[walls] = HIT
        self.odds = np.clip(self.odds + observed, -SURE, SURE)

    def cells(self, x, y):
        """Return the rows and the columns of those points [m] that lie in the map."""
        row = np.floor((y - BOTTOM) / RESOLUTION).astype(int)
        column = np.floor((x - LEFT) / RESOLUTION).astype(int)
        inside = (row >= 0) & (row < HEIGHT) & (column >= 0) & (column < WIDTH)
        return row[inside], column[inside]

    def grid(self):
        """Return the map: an array of rows, from the lowest y on."""
        grid = np.full((HEIGHT, WIDTH), UNKNOWN, dtype=np.int8)
        grid[self.odds < -0.3] = FREE
        grid[self.odds > 0.5] = OCCUPIED
        return grid

    def publish_map(self):
        message = OccupancyGrid()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = "odom"
        message.info.resolution = RESOLUTION
        message.info.width, message.info.height = WIDTH, HEIGHT
        message.info.origin.position.x, message.info.origin.position.y = LEFT, BOTTOM
        message.info.origin.orientation.w = 1.0
        message.data = self.grid().flatten().tolist()
        self.maps.publish(message)

    def drive(self):
        command = Twist()
        if self.poses:
            _, x, y, heading = self.poses[-1]
            self.plan(x, y)
            if self.path:
                row, column = self.path[min(4, len(self.path) - 1)]
                ahead = LEFT + (column + 0.5) * RESOLUTION - x, BOTTOM + (row + 0.5) * RESOLUTION - y
                error = remainder(atan2(ahead[1], ahead[0]) - heading, 2 * pi)
                command.angular.z = max(-TURN, min(TURN, 2.5 * error))
                if abs(error) < 0.6 and hypot(*ahead) > 0.02:
                    command.linear.x = SPEED * (1 - abs(error) / 0.6)
        self.commands.publish(command)

    def plan(self, x, y):
        """Find the way to the nearest frontier: a cell that can be reached, with unknown cells beside it."""
        (row,), (column,) = self.cells(np.array([x]), np.array([y]))
        grid = self.grid()
        near_wall = grown(grid == OCCUPIED, AWAY)
        # Where the robot is too near to a wall, it may leave.
        near_wall[row - 2 : row + 3, column - 2 : column + 3] = False
        open_cells = (grid == FREE) & ~near_wall
        frontier = open_cells & grown(grid == UNKNOWN, 1)
        before, queue = {(row, column): None}, deque([(row, column)])
        while queue:
            cell = queue.popleft()
            if frontier[cell]:
                break
            for step in ((0, 1), (1, 0), (0, -1), (-1, 0)):
                beside = cell[0] + step[0], cell[1] + step[1]
                if open_cells[beside] and beside not in before:
                    before[beside] = cell
                    queue.append(beside)
        else:
            self.path = []
            return
        self.path = []
        while cell is not None:
            self.path.insert(0, cell)
            cell = before[cell]


def grown(cells, by):
    """Return the cells that are at most `by` cells away from one of `cells`, in a circle."""
    out = cells.copy()
    for dy in range(-by, by + 1):
        for dx in range(-by, by + 1):
            if 0 < dx * dx + dy * dy <= by * by + 1:
                out |= np.roll(cells, (dy, dx), axis=(0, 1))
    return out


def main():
    rclpy.init()
    rclpy.spin(Mapper())


if __name__ == "__main__":
    main()
