"""The shortest way through a grid by a search in breadth."""

from collections import deque

import numpy as np
import rclpy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid, Path
from rclpy.node import Node


def shortest(free: np.ndarray, start: tuple[int, int], goal: tuple[int, int]) -> list[tuple[int, int]]:
    came_from = {start: None}
    waiting = deque([start])
    while waiting:
        cell = waiting.popleft()
        if cell == goal:
            way = []
            while cell is not None:
                way.append(cell)
                cell = came_from[cell]
            return way[::-1]
        row, column = cell
        for near in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            inside = 0 <= near[0] < free.shape[0] and 0 <= near[1] < free.shape[1]
            if inside and free[near] and near not in came_from:
                came_from[near] = cell
                waiting.append(near)
    return []


class Planner(Node):
    def __init__(self):
        super().__init__("planner")
        self.out = self.create_publisher(Path, "/way", 10)
        self.create_subscription(OccupancyGrid, "/map", self.on_map, 10)

    def on_map(self, grid):
        cells = np.array(grid.data, dtype=np.int16).reshape(grid.info.height, grid.info.width)
        path = Path(header=grid.header)
        for row, column in shortest(cells == 0, (0, 0), (grid.info.height - 1, grid.info.width - 1)):
            pose = PoseStamped(header=grid.header)
            pose.pose.position.x = grid.info.origin.position.x + (column + 0.5) * grid.info.resolution
            pose.pose.position.y = grid.info.origin.position.y + (row + 0.5) * grid.info.resolution
            pose.pose.orientation.w = 1.0
            path.poses.append(pose)
        self.out.publish(path)


def main():
    rclpy.init()
    rclpy.spin(Planner())


if __name__ == "__main__":
    main()
