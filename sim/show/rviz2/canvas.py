"""What drawings are made on: a recording stream of Rerun, its time line, and the tree of coordinate frames."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

TIMELINE = "time"  # [s] since the watch began
ROOT = "tf#/"  # Rerun's name of the frame in which its views look
AXES = 0.25  # [m]
LONGEST_TRAIL = 5_000  # points of a path
TRAIL_STEP = 0.01  # [m] between two of them
MOST_HZ = 30.0  # of a transform
LONGEST_TEXT = 2_000  # characters
Place = Sequence[float]


class Canvas:
    """A stream of Rerun on which messages are drawn. Use it from one thread.

    `tell` gets each sentence about what cannot be drawn, once.
    """

    def __init__(self, stream: Any, tell: Callable[[str], None] = print) -> None:
        self.stream = stream
        self.frames = Frames(self)
        self.pictures: list[str] = []
        """The entities that hold pictures, in the order in which they came."""
        self._tell = tell
        self._said: set[str] = set()
        self._frame_of: dict[str, str] = {}
        self._due: dict[str, float] = {}
        self._trails: dict[str, deque[tuple[float, ...]]] = {}
        self._started = time.monotonic()
        self.now = 0.0

    def begin(self) -> None:
        """Set the time of what is drawn next to the present."""
        self.now = time.monotonic() - self._started
        self.stream.set_time(TIMELINE, duration=self.now)

    def log(self, entity: str, archetype: Any) -> None:
        self.stream.log(entity, archetype)

    def in_frame(self, entity: str, frame: str) -> None:
        """Put an entity into a coordinate frame of ROS."""
        import rerun as rr

        frame = frame.lstrip("/")
        self.frames.need(frame)
        if frame and self._frame_of.get(entity) != frame:
            self._frame_of[entity] = frame
            self.stream.log(entity, rr.CoordinateFrame(frame), static=True)

    def picture(self, entity: str, archetype: Any) -> None:
        if entity not in self.pictures:
            self.pictures.append(entity)
        self.log(entity, archetype)

    def scalar(self, entity: str, value: float) -> None:
        import rerun as rr

        if not math.isnan(value):
            self.log(f"/plots{entity}", rr.Scalars(value))

    def text(self, entity: str, text: str, level: str = "INFO") -> None:
        import rerun as rr

        line = text[:LONGEST_TEXT].encode(errors="replace").decode()
        self.log(f"/log{entity}", rr.TextLog(line, level=level))

    def clear(self, entity: str) -> None:
        import rerun as rr

        self.log(entity, rr.Clear(recursive=True))

    def say(self, sentence: str) -> None:
        """Tell the user, once, what cannot be drawn."""
        if sentence not in self._said:
            self._said.add(sentence)
            self._tell(sentence)
            self.text("/watch", sentence, "WARN")

    def is_due(self, entity: str, most_hz: float) -> bool:
        """Tell whether an entity that is drawn at most so often is drawn now."""
        if self.now < self._due.get(entity, 0.0):
            return False
        self._due[entity] = self.now + 1.0 / most_hz
        return True

    def trail(self, entity: str, place: Place) -> list[tuple[float, ...]]:
        """Return the path with a new place at its end [m], empty if it has not moved on."""
        trail = self._trails.setdefault(entity, deque(maxlen=LONGEST_TRAIL))
        if trail and math.dist(trail[-1], place) < TRAIL_STEP:
            return []
        trail.append(tuple(place))
        return list(trail) if len(trail) > 1 else []


class Frames:
    """The tree of coordinate frames in the terms of Rerun.

    A frame that is nobody's child hangs below the frame of the view. Odometry stands for the transform that it
    describes if `/tf` has none. A frame that nobody connects is put at the robot's, and the user is told.
    """

    def __init__(self, canvas: Canvas) -> None:
        self._canvas = canvas
        self._parents: dict[str, str] = {}
        self._of_tf: set[str] = set()
        self._base = ""

    def set(self, parent: str, child: str, place: Place, turn: Place) -> None:
        """Take a transform of `/tf` or of a message."""
        self._of_tf.add(child.lstrip("/"))
        if self._canvas.is_due(f"/tf/{child}", MOST_HZ):
            self._connect(parent.lstrip("/"), child.lstrip("/"), place, turn)

    def suggest(self, parent: str, child: str, place: Place, turn: Place) -> None:
        """Take a transform of an odometry message."""
        parent, child = parent.lstrip("/"), child.lstrip("/")
        self._base = self._base or child
        if child and child not in self._of_tf:
            self._connect(parent, child, place, turn)

    def need(self, frame: str) -> None:
        """Make sure that a frame is in the tree."""
        if not frame or frame in self._parents:
            return
        at = self._base if self._base in self._parents and self._base != frame else ""
        if at:
            self._canvas.say(f"no transform to the frame {frame} is known; what is in it is drawn at {at}")
        self._connect(at, frame, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))

    def _connect(self, parent: str, child: str, place: Place, turn: Place) -> None:
        import rerun as rr

        if not child or parent == child:
            return
        is_new = child not in self._parents
        self._parents[child] = parent
        if parent and parent not in self._parents:
            self._connect("", parent, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
        entity = f"/tf/{child}"
        if not all(map(math.isfinite, (*place, *turn))):
            self._canvas.say(f"the transform from {parent} to {child} has numbers that are not finite")
            return
        transform = rr.Transform3D(
            translation=place, quaternion=turn, parent_frame=parent or ROOT, child_frame=child, relation=None
        )
        self._canvas.log(entity, transform)
        if is_new:
            self._canvas.stream.log(entity, rr.CoordinateFrame(child), rr.TransformAxes3D(AXES), static=True)
