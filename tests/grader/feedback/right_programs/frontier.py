"""Explore rooms that nobody has seen, and map them."""

from collections import deque
from math import atan2, ceil, cos, hypot, pi, remainder, sin

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

RESOLUTION = 0.1  # [m] side of a cell
WIDTH, HEIGHT = 100, 80  # [cells] along x and along y
LEFT, BOTTOM = -5.0, -4.0  # [m] the corner of the cell (0, 0) in odom
UNKNOWN, FREE, OCCUPIED = -1, 0, 100
KEEP_AWAY = 0.31  # [m] from the middle of an occupied cell
SPEED, TURN = 0.45, 1.2  # [m/s] [rad/s]


def seconds(stamp):
    return stamp.sec + stamp.nanosec * 1e-9


def cell_of(x, y):
    return int((y - BOTTOM) // RESOLUTION), int((x - LEFT) // RESOLUTION)


def middle_of(row, column):
    return LEFT + (column + 0.5) * RESOLUTION, BOTTOM + (row + 0.5) * RESOLUTION


def grown(mask, radius):
    """The cells whose middle is within `radius` [m] of that of a cell of the mask."""
    n = int(ceil(radius / RESOLUTION))
    out = np.zeros_like(mask)
    padded = np.pad(mask, n)
    for dr in range(-n, n + 1):
        for dc in range(-n, n + 1):
            if hypot(dr, dc) * RESOLUTION <= radius:
                out |= padded[n + dr : n + dr + HEIGHT, n + dc : n + dc + WIDTH]
    return out


class Mapper(Node):
    """Hears /odom and /scan, publishes /map, and drives by /cmd_vel."""

    def __init__(self):
        super().__init__("mapper")
        self.maps = self.create_publisher(OccupancyGrid, "/map", 10)
        self.commands = self.create_publisher(Twist, "/cmd_vel", 10)
        self.poses = deque(maxlen=50)  # (time, x, y, heading)
        self.waiting = deque(maxlen=20)  # scans that are newer than the last pose
        self.scan = None
        self.hits = np.zeros((HEIGHT, WIDTH), dtype=int)
        self.passes = np.zeros((HEIGHT, WIDTH), dtype=int)
        self.create_subscription(Odometry, "/odom", self.on_odom, 10)
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
        self.create_timer(1.0, self.publish_map)
        self.create_timer(0.2, self.drive)

    # -- mapping ------------------------------------------------------------------------------------------------------

    def on_odom(self, message):
        p, q = message.pose.pose.position, message.pose.pose.orientation
        self.poses.append((seconds(message.header.stamp), p.x, p.y, 2 * atan2(q.z, q.w)))
        self.match()

    def on_scan(self, scan):
        self.scan = scan
        self.waiting.append(scan)
        self.match()

    def match(self):
        """Adds every scan whose pose is known by now."""
        while self.waiting and self.poses and seconds(self.waiting[0].header.stamp) <= self.poses[-1][0] + 0.003:
            scan = self.waiting.popleft()
            pose = self.pose_at(seconds(scan.header.stamp))
            if pose is not None:
                self.add(scan, *pose)

    def pose_at(self, time):
        best = min(self.poses, key=lambda pose: abs(pose[0] - time))
        if abs(best[0] - time) < 0.005:
            return best[1:]
        for (t0, x0, y0, h0), (t1, x1, y1, h1) in zip(self.poses, list(self.poses)[1:]):
            if t0 <= time <= t1:
                part = (time - t0) / (t1 - t0)
                return x0 + part * (x1 - x0), y0 + part * (y1 - y0), h0 + part * remainder(h1 - h0, 2 * pi)
        return None

    def add(self, scan, x, y, heading):
        ranges = np.asarray(scan.ranges, dtype=float)
        angles = heading + scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        hit = (ranges >= scan.range_min) & (ranges <= scan.range_max)
        far = np.isposinf(ranges)
        self.count(self.hits, x + ranges[hit] * np.cos(angles[hit]), y + ranges[hit] * np.sin(angles[hit]))
        # steps along all rays; a ray passes what is at least a cell before its end
        ends = np.where(hit, ranges - 0.1, np.where(far, scan.range_max - 0.1, 0.0))
        steps = np.arange(0.0, scan.range_max, RESOLUTION / 2)
        on_way = steps[None, :] < ends[:, None]
        px = x + steps[None, :] * np.cos(angles)[:, None]
        py = y + steps[None, :] * np.sin(angles)[:, None]
        ray = np.broadcast_to(np.arange(len(ranges))[:, None], px.shape)
        self.count(self.passes, px[on_way], py[on_way], ray[on_way])

    def count(self, counts, x, y, ray=None):
        rows = np.floor((y - BOTTOM) / RESOLUTION).astype(int)
        columns = np.floor((x - LEFT) / RESOLUTION).astype(int)
        inside = (rows >= 0) & (rows < HEIGHT) & (columns >= 0) & (columns < WIDTH)
        cells = rows * WIDTH + columns
        if ray is not None:  # each ray counts once in each cell
            cells, inside = np.unique(ray[inside] * (WIDTH * HEIGHT) + cells[inside]) % (WIDTH * HEIGHT), slice(None)
        np.add.at(counts.reshape(-1), cells[inside], 1)

    def grid(self):
        grid = np.full((HEIGHT, WIDTH), UNKNOWN, dtype=np.int8)
        grid[self.passes > 0] = FREE
        grid[(self.hits >= 2) & (self.hits >= 0.15 * (self.hits + self.passes))] = OCCUPIED
        return grid

    def publish_map(self):
        message = OccupancyGrid()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = "odom"
        message.info.map_load_time = message.header.stamp
        message.info.resolution = RESOLUTION
        message.info.width, message.info.height = WIDTH, HEIGHT
        message.info.origin.position.x, message.info.origin.position.y = LEFT, BOTTOM
        message.info.origin.orientation.w = 1.0
        message.data = self.grid().ravel().tolist()
        self.maps.publish(message)

    # -- driving ------------------------------------------------------------------------------------------------------

    def drive(self):
        command = Twist()
        if self.poses and self.scan is not None:
            _, x, y, heading = self.poses[-1]
            goal = self.next_place(x, y)
            if goal is not None:
                error = remainder(atan2(goal[1] - y, goal[0] - x) - heading, 2 * pi)
                command.angular.z = max(-TURN, min(TURN, 1.6 * error))
                if abs(error) < 0.6:
                    command.linear.x = max(0.0, min(SPEED * (1 - abs(error) / 0.8), 0.9 * (self.room_ahead() - 0.24)))
        self.commands.publish(command)

    def room_ahead(self):
        """The distance [m] of what is in the way of the robot if it drives straight on."""
        room = 3.0
        for number, distance in enumerate(self.scan.ranges):
            if not self.scan.range_min <= distance <= self.scan.range_max:
                continue
            angle = self.scan.angle_min + number * self.scan.angle_increment
            if abs(angle) < 1.3 and abs(distance * sin(angle)) < 0.21:
                room = min(room, distance * cos(angle))
        return room

    def next_place(self, x, y):
        """A point [m] a little ahead on the way to the nearest frontier, None if there is none."""
        grid = self.grid()
        unknown = np.pad(grid == UNKNOWN, 1).astype(int)
        beside_unknown = sum(
            unknown[1 + r : 1 + r + HEIGHT, 1 + c : 1 + c + WIDTH] for r in (-1, 0, 1) for c in (-1, 0, 1)
        )
        closed = grown(grid == OCCUPIED, KEEP_AWAY)
        open_cells = (grid == FREE) & ~closed
        open_cells[[0, -1], :] = open_cells[:, [0, -1]] = False
        frontier = open_cells & (beside_unknown >= 3)
        start = cell_of(x, y)
        if not open_cells[start]:  # too near to something: first to the nearest open cell
            rows, columns = np.nonzero(open_cells)
            if len(rows) == 0:
                return None
            nearest = np.argmin((rows - start[0]) ** 2 + (columns - start[1]) ** 2)
            return middle_of(rows[nearest], columns[nearest])
        path = self.search(open_cells, frontier, start)
        if not path:
            return None
        return middle_of(*path[min(4, len(path) - 1)])

    @staticmethod
    def search(open_cells, frontier, start):
        before = {start: None}
        queue = deque([start])
        while queue:
            cell = queue.popleft()
            # what the robot stands on is no goal: something would be wrong with it
            if frontier[cell] and max(abs(cell[0] - start[0]), abs(cell[1] - start[1])) > 2:
                path = []
                while cell is not None:
                    path.append(cell)
                    cell = before[cell]
                return path[::-1]
            row, column = cell
            for step in ((row, column + 1), (row + 1, column), (row, column - 1), (row - 1, column)):
                if step not in before and open_cells[step]:
                    before[step] = cell
                    queue.append(step)
        return []


def main():
    rclpy.init()
    rclpy.spin(Mapper())


if __name__ == "__main__":
    main()
