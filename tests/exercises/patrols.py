"""Recordings of patrols, and what the checks of `10_actions` find in them."""

import json
from importlib import import_module
from itertools import pairwise

import numpy as np

from gz_course.grader.record.reading import REPORTS, Line, Signal

CHECKS = import_module("gz_course.exercises.10_actions.grading.patrol_checks")


POINTS = [[1.2, 0.0], [1.2, 0.7]]


FROM, STEP = 1.0, 0.05  # [s] when the patrol is accepted, and between two ticks


class Patrol:
    """A recording of one patrol, driven along straight lines at a speed [m/s]."""

    def __init__(self, places=POINTS, speed=0.4, status="SUCCEEDED", visited=2, after=0.0):
        corners = [(0.0, 0.0), *map(tuple, places)]
        way, yaws, index = [(0.0, 0.0)] * round(FROM / STEP), [0.0] * round(FROM / STEP), [0] * round(FROM / STEP)
        for number, (here, there) in enumerate(pairwise(corners)):
            length = np.hypot(there[0] - here[0], there[1] - here[1])
            for share in np.arange(0, 1, speed * STEP / length):
                way.append((here[0] + share * (there[0] - here[0]), here[1] + share * (there[1] - here[1])))
                yaws.append(np.arctan2(there[1] - here[1], there[0] - here[0]))
                index.append(number)
        self.end = len(way) * STEP
        way += [(way[-1][0] + after * STEP * i, way[-1][1]) for i in range(20)]
        self.times = np.arange(len(way)) * STEP
        self.way, self.index = np.array(way), index
        yaws += [yaws[-1]] * 20
        fast = np.where((self.times > FROM) & (self.times < self.end), speed, 0.0)
        fast[self.times >= self.end] = after
        self.signals = {
            "truth/robot/x": self.way[:, 0],
            "truth/robot/y": self.way[:, 1],
            "truth/robot/yaw": np.array(yaws),
            "truth/robot/linear_x": fast,
            "truth/robot/angular_z": 0 * fast,
            "topics/cmd_vel/linear/x": fast,
        }
        self.events = [
            (0.2, "interface", "", {"fault": ""}),
            (0.9, "sent", "patrol", {"waypoints": POINTS, "speed": 0.4}),
        ]
        self.events += [(FROM, "accepted", "patrol", {})]
        if status:
            self.events.append((self.end, "result", "patrol", {"status": status, "visited": visited}))
            self.events.append((self.end + 0.5, "sent", "cancelled", {"waypoints": POINTS, "speed": 0.3}))

    def feedback(self, distance, waypoint=lambda i: i):
        """Add feedback every half second: `distance` of dx and dy to the waypoint."""
        for number in range(round(FROM / STEP), round(self.end / STEP), 10):
            i = self.index[number]
            dx, dy = np.array(POINTS[i]) - self.way[number]
            said = {"waypoint": waypoint(i), "distance": float(distance(dx, dy))}
            self.events.append((number * STEP, "feedback", "patrol", said))
        return self

    def signal(self, name):
        values = self.signals.get(name, np.empty(0))
        return Signal(np.round(self.times[: len(values)] * 1e9).astype(np.int64), values)

    def lines(self, entity):
        told = sorted(self.events, key=lambda event: event[0])
        return [
            Line(round(at * 1e9), json.dumps({"number": 0, "event": event, "goal": goal} | more), "INFO")
            for at, event, goal, more in told
            if entity == REPORTS
        ]

    def facts(self):
        return {}


def found(name, patrol):
    return getattr(CHECKS, name)(patrol, {})


def cancelled(patrol, status="CANCELED", visited=1, late=0.0, suspects=()):
    """Let a patrol be the one that is cancelled, at 4 s; its result comes `late` [s] after the robot has stopped."""
    events = [(at, event, "cancelled" if event != "interface" else "", more) for at, event, _, more in patrol.events]
    events = [each for each in events if each[1] != "result" and each[0] < 4.0]
    before = [(0.3, "sent", "patrol", {"waypoints": POINTS, "speed": 0.4}), (0.3, "accepted", "patrol", {})]
    before.append((0.4, "result", "patrol", {"status": "SUCCEEDED", "visited": 2}))
    ended = [(patrol.end + late, "result", "cancelled", {"status": status, "visited": visited})] if status else []
    patrol.events = before + events + [(4.0, "cancel", "cancelled", {})] + ended
    patrol.facts = lambda: {"suspects": list(suspects)}
    return found("cancel", patrol)
