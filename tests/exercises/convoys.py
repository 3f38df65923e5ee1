"""Recordings of convoys, and what the checks of `11_many_robots` say about a follower."""

from importlib import import_module
from types import SimpleNamespace

import numpy as np

from gz_course.grader.record.reading import Signal

TURNS = import_module("gz_course.exercises.11_many_robots.grading.follower_turns")
FITS = import_module("gz_course.exercises.11_many_robots.grading.follower_fits")


CHECKS = import_module("gz_course.exercises.11_many_robots.grading.convoy_checks")
TOPICS = import_module("gz_course.exercises.11_many_robots.grading.convoy_topics")


STEP, END = 0.05, 7.0


GAP = 1.2


class Run:
    """A recording of robot2, which follows robot1 by `rule`: a function of what it hears that returns its command."""

    def __init__(self, rule, delay=1):
        front = self.path(lambda now: (0.5 * (1.0 <= now < 5.0), 0.4 * (3.0 <= now < 5.0)))
        x = y = yaw = 0.0
        rows, old = [], []
        for index, now in enumerate(np.arange(0.0, END, STEP)):
            old.append((x, y, yaw, *front[index]))
            own_x, own_y, heading, front_x, front_y, front_yaw, v, w = old[max(0, index - delay)]
            h = SimpleNamespace(x=own_x, y=own_y, heading=heading, front_x=front_x, front_y=front_y, v=v, w=w)
            h.ahead, h.aside, h.front_heading = front_x + GAP - own_x, front_y - own_y, front_yaw
            linear, angular = rule(h)
            rows.append((now, linear, angular, x, y, yaw, *front[index]))
            x, y, yaw = self.moved(x, y, yaw, linear, angular)
        columns = np.array(rows).T
        now, linear, angular, x, y, yaw, front_x, front_y, front_yaw, v, w = columns
        self.signals = {
            "topics/robot2/cmd_vel/linear/x": (now, linear),
            "topics/robot2/cmd_vel/angular/z": (now, angular),
        }
        for robot, place in (("robot2", (x, y, yaw, linear, angular)), ("robot1", (front_x, front_y, front_yaw, v, w))):
            base = f"topics/{robot}/odom"
            self.signals |= {f"{base}/pose/pose/position/{axis}": (now, place[i]) for i, axis in enumerate("xy")}
            self.signals |= {f"{base}/pose/pose/orientation/z": (now, np.sin(place[2] / 2))}
            self.signals |= {f"{base}/pose/pose/orientation/w": (now, np.cos(place[2] / 2))}
            self.signals |= {f"{base}/twist/twist/linear/x": (now, place[3])}
            self.signals |= {f"{base}/twist/twist/angular/z": (now, place[4])}

    def moved(self, x, y, yaw, linear, angular):
        return x + linear * np.cos(yaw) * STEP, y + linear * np.sin(yaw) * STEP, yaw + angular * STEP

    def path(self, commands):
        x = y = yaw = 0.0
        rows = []
        for now in np.arange(0.0, END, STEP):
            v, w = commands(now)
            rows.append((x, y, yaw, v, w))
            x, y, yaw = self.moved(x, y, yaw, v, w)
        return rows

    def signal(self, name):
        times, values = self.signals.get(name, (np.empty(0), np.empty(0)))
        return Signal(np.round(np.asarray(times) * 1e9).astype(np.int64), np.asarray(values, dtype=float))


def wrapped(angle):
    return np.arctan2(np.sin(angle), np.cos(angle))


def bearing(h):
    return np.arctan2(h.aside, h.ahead)


def distance(h):
    return np.hypot(h.ahead, h.aside)


def speed_of(length, least=0.0, most=0.8, gain=1.5):
    return float(np.clip(gain * length, least, most))


def place(h, begins=GAP):
    """Return where the place behind the robot in front is, as seen by the follower."""
    return (
        h.front_x + begins - GAP * np.cos(h.front_heading) - h.x,
        h.front_y - GAP * np.sin(h.front_heading) - h.y,
    )


def rule(speed=lambda h: speed_of(distance(h) - GAP), angle=lambda h: wrapped(bearing(h) - h.heading)):
    return lambda h: (speed(h), float(np.clip(2.0 * angle(h), -1.5, 1.5)))


def told(rule, about, delay=1):
    heard = FITS.heard(Run(rule, delay), "robot2", "robot1")
    return getattr(TURNS if about == "turning" else FITS, about)(heard)
