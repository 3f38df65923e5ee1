"""What happened in a run: the reports of the dispatcher, and the way of the robot."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from gz_course.grader.record.reading import REPORTS, Recording

NEAR = 0.17  # [m] 0.15, and what odometry may be wrong


class Run:
    """The events of a run, by name and goal, and the way of the robot in the frame odom."""

    def __init__(self, recording: Recording) -> None:
        self.recording = recording
        self.events = []
        for line in recording.lines(REPORTS):
            self.events.append(json.loads(line.text) | {"at": line.time_ns / 1e9})
        x, y, yaw, self.linear, self.angular = (
            recording.signal(f"truth/robot/{name}") for name in ("x", "y", "yaw", "linear_x", "angular_z")
        )
        self.times = x.times / 1e9
        self.end = float(self.times[-1]) if len(self.times) else 0.0
        if len(self.times):
            east, north = x.values - x.values[0], y.values - y.values[0]
            c, s = np.cos(yaw.values[0]), np.sin(yaw.values[0])
            self.way = np.column_stack((c * east + s * north, c * north - s * east))
            self.heading = yaw.values - yaw.values[0]

    def all(self, event: str, goal: str) -> list[Any]:
        return [each for each in self.events if each["event"] == event and each["goal"] == goal]

    def one(self, event: str, goal: str = "") -> Any:
        return next(iter(self.all(event, goal)), None)

    def period(self, goal: str) -> tuple[float, float]:
        """Return when a goal was accepted and when its result came, or the end of the run."""
        result = self.one("result", goal)
        return self.one("accepted", goal)["at"], result["at"] if result else self.end

    def waypoints(self, goal: str) -> list[Any]:
        return self.one("sent", goal)["waypoints"]

    def nearest(self, goal: str, until: float, near: float = NEAR) -> tuple[int, float]:
        """Return how many waypoints were reached in their order, and how near the robot came to the next one."""
        start, _ = self.period(goal)
        way = self.way[(self.times >= start) & (self.times <= until)]
        for count, point in enumerate(self.waypoints(goal)):
            left = np.hypot(*(way - np.array(point)).T) if len(way) else np.array([np.inf])
            if left.min() > near:
                return count, float(left.min())
            way = way[int(np.argmax(left <= near)) :]
        return len(self.waypoints(goal)), 0.0
