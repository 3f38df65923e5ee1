"""Odometry of a differential drive, computed from its wheel angles alone.

DiffDrive updates it after every step. A step is integrated along a circular arc, or with the midpoint rule if it is
nearly straight; speeds are means over the last ten steps. The result drifts when wheels slip, as on a real robot.

Source: https://github.com/gazebosim/gz-math/blob/gz-math7/src/DiffDriveOdometry.cc
"""

from __future__ import annotations

import math
from collections import deque

WINDOW = 10
_MOST_WAITING = 1000


class WheelOdometry:
    """A planar pose and speeds; steps are stored and integrated when a value is read."""

    __slots__ = ("_heading", "_last", "_left", "_radius", "_right", "_separation", "_x", "_y", "waiting")

    def __init__(self, wheel_separation: float, wheel_radius: float) -> None:
        self._separation = wheel_separation
        self._radius = wheel_radius
        self.waiting: list[tuple[float, float, float]] = []
        """The stored steps, as in `update`; always the same list."""
        self.reset(0.0, 0.0)

    def reset(self, left_angle: float, right_angle: float) -> None:
        """Start at the origin with the wheels at these angles [rad]."""
        self._x = self._y = self._heading = 0.0
        self._left = left_angle
        self._right = right_angle
        self._last: deque[tuple[float, float, float]] = deque(maxlen=WINDOW)
        self.waiting.clear()

    def update(self, left_angle: float, right_angle: float, dt: float) -> None:
        """Take the wheel angles [rad] after a step of `dt` [s]."""
        self.waiting.append((left_angle, right_angle, dt))
        if self.is_full:
            self.catch_up()

    @property
    def is_full(self) -> bool:
        """True if so many steps are stored that they should be integrated."""
        return len(self.waiting) >= _MOST_WAITING

    def catch_up(self) -> None:
        """Integrate the stored steps."""
        if not self.waiting:
            return
        wheel, separation = self._radius, self._separation
        before_left, before_right = self._left, self._right
        x, y, heading = self._x, self._y, self._heading
        last, cos, sin = self._last, math.cos, math.sin
        sine, cosine = sin(heading), cos(heading)
        for left_angle, right_angle, dt in self.waiting:
            left = (left_angle - before_left) * wheel
            right = (right_angle - before_right) * wheel
            before_left, before_right = left_angle, right_angle
            distance = (left + right) * 0.5
            turn = (right - left) / separation
            after = heading + turn
            old_sine, old_cosine = sine, cosine
            sine, cosine = sin(after), cos(after)
            if -1e-6 < turn < 1e-6:
                middle = heading + turn * 0.5
                x += distance * cos(middle)
                y += distance * sin(middle)
            else:
                radius = distance / turn
                x += radius * (sine - old_sine)
                y -= radius * (cosine - old_cosine)
            heading = after
            last.append((distance, turn, dt))
        self.waiting.clear()
        self._left, self._right = before_left, before_right
        self._x, self._y, self._heading = x, y, heading

    @property
    def x(self) -> float:
        """The way along the x axis of the start [m]."""
        self.catch_up()
        return self._x

    @property
    def y(self) -> float:
        """The way along the y axis of the start [m]."""
        self.catch_up()
        return self._y

    @property
    def heading(self) -> float:
        """The turn since the start [rad], not wrapped."""
        self.catch_up()
        return self._heading

    @property
    def linear(self) -> float:
        """Mean forward speed [m/s] over the last ten steps."""
        self.catch_up()
        return sum([distance / dt for distance, _, dt in self._last]) / len(self._last) if self._last else 0.0

    @property
    def angular(self) -> float:
        """Mean turning speed [rad/s] over the last ten steps."""
        self.catch_up()
        return sum([turn / dt for _, turn, dt in self._last]) / len(self._last) if self._last else 0.0
