"""Odometry of a differential drive, computed from its wheel angles alone.

DiffDrive updates it after every step. A step is integrated along a circular arc, or with the midpoint rule if it is
nearly straight; speeds are means over the last ten steps. The result drifts when wheels slip, as on a real robot.

Source: https://github.com/gazebosim/gz-math/blob/gz-math7/src/DiffDriveOdometry.cc
"""

from __future__ import annotations

import math
from collections import deque

WINDOW = 10


class WheelOdometry:
    """A planar pose `x`, `y` [m], `heading` [rad] (not wrapped), and the speeds `linear` [m/s], `angular` [rad/s]."""

    __slots__ = ("_angular", "_left", "_linear", "_radius", "_right", "_separation", "heading", "x", "y")

    def __init__(self, wheel_separation: float, wheel_radius: float) -> None:
        self._separation = wheel_separation
        self._radius = wheel_radius
        self.reset(0.0, 0.0)

    def reset(self, left_angle: float, right_angle: float) -> None:
        """Start at the origin with the wheels at these angles [rad]."""
        self.x = self.y = self.heading = 0.0
        self._left = left_angle
        self._right = right_angle
        self._linear: deque[float] = deque(maxlen=WINDOW)
        self._angular: deque[float] = deque(maxlen=WINDOW)

    def update(self, left_angle: float, right_angle: float, dt: float) -> None:
        """Integrate the wheel angles [rad] after a step of `dt` [s]."""
        left = (left_angle - self._left) * self._radius
        right = (right_angle - self._right) * self._radius
        self._left = left_angle
        self._right = right_angle
        distance = (left + right) * 0.5
        turn = (right - left) / self._separation
        heading = self.heading
        if -1e-6 < turn < 1e-6:
            middle = heading + turn * 0.5
            self.x += distance * math.cos(middle)
            self.y += distance * math.sin(middle)
        else:
            radius = distance / turn
            self.x += radius * (math.sin(heading + turn) - math.sin(heading))
            self.y -= radius * (math.cos(heading + turn) - math.cos(heading))
        self.heading = heading + turn
        self._linear.append(distance / dt)
        self._angular.append(turn / dt)

    @property
    def linear(self) -> float:
        """Mean forward speed [m/s] over the last ten steps."""
        return sum(self._linear) / len(self._linear) if self._linear else 0.0

    @property
    def angular(self) -> float:
        """Mean turning speed [rad/s] over the last ten steps."""
        return sum(self._angular) / len(self._angular) if self._angular else 0.0
