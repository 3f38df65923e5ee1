#!/usr/bin/env python3
# Mapper with log odds. Everything is done when odometry and scan of one moment are there: map, plan, command.
import heapq
import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

RES, NX, NY, X0, Y0 = 0.1, 100, 80, -5.0, -4.0
HIT, MISS, LIMIT = 0.9, -0.25, 6.0


class Grid:
    def __init__(self):
        self.odds = np.zeros((NY, NX))
        self.seen = np.zeros((NY, NX), bool)

    @staticmethod
    def index(x, y):
        return math.floor((y - Y0) / RES), math.floor((x - X0) / RES)

    @staticmethod
    def centre(i, j):
        return X0 + RES * (j + 0.5), Y0 + RES * (i + 0.5)

    def insert(self, scan, x, y, yaw):
        hits, free = set(), {}
        for k, r in enumerate(scan.ranges):
            a = yaw + scan.angle_min + k * scan.angle_increment
            ca, sa = math.cos(a), math.sin(a)
            if scan.range_min <= r <= scan.range_max:
                hits.add(self.index(x + r * ca, y + r * sa))
                end = r - 0.12
            elif r == math.inf:
                end = scan.range_max - 0.05
            else:
                continue
            s, cells = 0.0, set()
            while s < end:
                cells.add(self.index(x + s * ca, y + s * sa))
                s += 0.04
            for c in cells:
                free[c] = free.get(c, 0) + 1
        for i, j in free:
            if (i, j) not in hits and 0 <= i < NY and 0 <= j < NX:
                self.odds[i, j] += MISS
                self.seen[i, j] = True
        for i, j in hits:
            if 0 <= i < NY and 0 <= j < NX:
                self.odds[i, j] += HIT
                self.seen[i, j] = True
        np.clip(self.odds, -LIMIT, LIMIT, out=self.odds)

    def occupied(self):
        return self.seen & (self.odds > 0.5)

    def values(self):
        v = np.full((NY, NX), -1, np.int8)
        v[self.seen] = 0
        v[self.occupied()] = 100
        return v


def clearance_of(blocked, most=6):
    """Distance of each cell to the nearest blocked one [cells], up to `most`."""
    d = np.full(blocked.shape, float(most))
    where = np.argwhere(blocked)
    for di in range(-most, most + 1):
        for dj in range(-most, most + 1):
            h = math.hypot(di, dj)
            if h < most:
                i, j = where[:, 0] + di, where[:, 1] + dj
                ok = (i >= 0) & (i < NY) & (j >= 0) & (j < NX)
                d[i[ok], j[ok]] = np.minimum(d[i[ok], j[ok]], h)
    return d


class Explorer(Node):
    def __init__(self):
        super().__init__("explorer")
        self.grid = Grid()
        self.odoms, self.scans = {}, {}
        self.pose = self.scan = None
        self.pub_map = self.create_publisher(OccupancyGrid, "/map", 1)
        self.pub_cmd = self.create_publisher(Twist, "/cmd_vel", 1)
        self.create_subscription(Odometry, "/odom", lambda m: self.keep(self.odoms, m), 20)
        self.create_subscription(LaserScan, "/scan", lambda m: self.keep(self.scans, m), 20)
        self.create_timer(1.0, self.on_second)

    @staticmethod
    def stamp(m):
        # in units of 10 ms: odometry and scan of one moment may differ by a step of the simulator
        return round((m.header.stamp.sec + m.header.stamp.nanosec / 1e9) * 100)

    def keep(self, store, message):
        store[self.stamp(message)] = message
        for t in sorted(self.scans):
            near = [o for o in (t, t - 1, t + 1) if o in self.odoms]
            if near:
                self.on_pair(self.odoms[near[0]], self.scans.pop(t))
        for s in (self.odoms, self.scans):
            while len(s) > 30:
                del s[min(s)]

    def on_pair(self, odom, scan):
        p, q = odom.pose.pose.position, odom.pose.pose.orientation
        self.pose = (p.x, p.y, math.atan2(2 * q.w * q.z, 1 - 2 * q.z * q.z))
        self.scan = scan
        self.grid.insert(scan, *self.pose)
        v, w = self.decide()
        cmd = Twist()
        cmd.linear.x, cmd.angular.z = float(v), float(w)
        self.pub_cmd.publish(cmd)

    def decide(self):
        x, y, yaw = self.pose
        way = self.plan(self.grid.index(x, y))
        if not way:
            return 0.0, 0.0
        tx, ty = self.grid.centre(*way[min(len(way) - 1, 4)])
        err = math.remainder(math.atan2(ty - y, tx - x) - yaw, math.tau)
        w = max(-1.2, min(1.2, 1.5 * err))
        if abs(err) > 0.7:
            return 0.0, w
        # nothing may be in the strip before the robot
        gap = min(
            (r * math.cos(a) for a, r in self.beams() if abs(a) < 1.3 and abs(r * math.sin(a)) < 0.21), default=3.0
        )
        v = 0.45 * math.cos(err) ** 4
        return max(0.0, min(v, 0.8 * (gap - 0.25))), w

    def beams(self):
        s = self.scan
        for k, r in enumerate(s.ranges):
            if s.range_min <= r <= s.range_max:
                yield s.angle_min + k * s.angle_increment, r

    def plan(self, start):
        """Dijkstra to the cheapest frontier; cells near to walls cost more, and the nearest ones are closed."""
        v = self.grid.values()
        clear = clearance_of(v == 100)
        unknown = v == -1
        cost = {start: 0.0}
        before = {}
        heap = [(0.0, start)]
        done = set()
        while heap:
            c, cell = heapq.heappop(heap)
            if cell in done:
                continue
            done.add(cell)
            i, j = cell
            if v[cell] == 0 and clear[cell] >= 3.0 and c > 2.5 and unknown[i - 1 : i + 2, j - 1 : j + 2].sum() >= 3:
                way = [cell]
                while way[-1] != start:
                    way.append(before[way[-1]])
                return way[::-1]
            for di, dj in ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)):
                n = (i + di, j + dj)
                if not (1 <= n[0] < NY - 1 and 1 <= n[1] < NX - 1) or v[n] != 0:
                    continue
                # closed is what is nearer than 0.3 m to a wall, unless the robot is there and gets out
                if clear[n] < 3.0 and clear[n] <= clear[cell]:
                    continue
                nc = c + math.hypot(di, dj) * (1.0 + max(0.0, 5.0 - clear[n]))
                if nc < cost.get(n, math.inf):
                    cost[n] = nc
                    before[n] = cell
                    heapq.heappush(heap, (nc, n))
        return []

    def on_second(self):
        m = OccupancyGrid()
        m.header.frame_id = "odom"
        m.header.stamp = self.get_clock().now().to_msg()
        m.info.resolution = RES
        m.info.width = NX
        m.info.height = NY
        m.info.origin.position.x = X0
        m.info.origin.position.y = Y0
        m.info.origin.orientation.w = 1.0
        m.data = [int(c) for row in self.grid.values() for c in row]
        self.pub_map.publish(m)


def main():
    rclpy.init()
    rclpy.spin(Explorer())


if __name__ == "__main__":
    main()
