"""The keys and what they mean: directions, and changes of speed.

Source: https://github.com/ros2/teleop_twist_keyboard (README.md: keys; speed 0.5 m/s, turn 1.0 rad/s, steps of 10 %)
"""

from __future__ import annotations

from dataclasses import dataclass, field

END = "\x03"  # Ctrl-C, as a terminal sends it when it makes no signal of it
Direction = tuple[int, int, int, int]
STOP: Direction = (0, 0, 0, 0)
# linear x, y, z, angular z
MOVES: dict[str, Direction] = {
    "u": (1, 0, 0, 1), "i": (1, 0, 0, 0), "o": (1, 0, 0, -1),
    "j": (0, 0, 0, 1), "l": (0, 0, 0, -1),
    "m": (-1, 0, 0, -1), ",": (-1, 0, 0, 0), ".": (-1, 0, 0, 1),
    "U": (1, 1, 0, 0), "I": (1, 0, 0, 0), "O": (1, -1, 0, 0),
    "J": (0, 1, 0, 0), "L": (0, -1, 0, 0),
    "M": (-1, 1, 0, 0), "<": (-1, 0, 0, 0), ">": (-1, -1, 0, 0),
    "t": (0, 0, 1, 0), "b": (0, 0, -1, 0),
}  # fmt: skip
# factors of speed and turn
SPEEDS = {
    "q": (1.1, 1.1), "z": (0.9, 0.9),
    "w": (1.1, 1.0), "x": (0.9, 1.0),
    "e": (1.0, 1.1), "c": (1.0, 0.9),
}  # fmt: skip

HELP = """\
Every key is sent as a Twist (`stamped`: TwistStamped). The keys are placed for a US keyboard.

   u    i    o      drive; to turn on the spot: j, l
   j    k    l
   m    ,    .

With shift, for robots that can move sideways:

   U    I    O
   J    K    L
   M    <    >

t, b    up, down (+z, -z)
q, z    both speeds 10 % higher, lower
w, x    only the linear one
e, c    only the angular one

Any other key stops the robot; Ctrl-C stops it and ends.
"""


@dataclass
class Command:
    """What was last asked for: `speed` [m/s], `turn` [rad/s] and a direction."""

    speed: float
    turn: float
    direction: Direction = field(default=STOP)

    def press(self, key: str) -> bool:
        """Apply a key; return whether it has changed the speeds."""
        if key in SPEEDS:
            linear, angular = SPEEDS[key]
            self.speed *= linear
            self.turn *= angular
            return True
        self.direction = MOVES.get(key, STOP)
        return False

    @property
    def velocity(self) -> tuple[float, float, float, float]:
        """Linear x, y, z [m/s] and angular z [rad/s]."""
        x, y, z, angular = self.direction
        return x * self.speed, y * self.speed, z * self.speed, angular * self.turn

    def __str__(self) -> str:
        return f"currently:\tspeed {self.speed:.4g}\tturn {self.turn:.4g}"
