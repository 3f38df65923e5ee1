"""The writer of a run's recording: numbers, poses, scans and log lines on the timeline `sim_time`.

Rows are collected and sent in blocks at fixed simulated times; everything else is flushed at once. No flush depends on
the wall clock: the same run gives the same chunks in the same order, and `rerun rrd compare` finds two recordings of it
equal. Their bytes differ, because the SDK numbers recordings, chunks and rows by the time of the day. A crash loses at
most one block. The file is called `NAME.rrd.part` until `close()`.

Entities (checks in a manifest name them without the leading slash):

    /world/MODEL, /world/MODEL/LINK          Transform3D, shapes below them (static)
    /world/scan/TOPIC, /world/path/MODEL     what the 3-D view shows
    /truth/MODEL/{x,y,z,qw,qx,qy,qz,yaw,linear_x,angular_z,distance}   the simulator's truth
    /topics/TOPIC/FIELD/...                  every numeric field of every message seen on a ROS topic; texts when they
                                             change
    /topics/TOPIC                            EncodedImage, pictures as JPEG, at most one each PICTURE_NS; `ros_type`,
                                             the type of the topic's messages
    /parameters/NAME                         the numeric parameters of the trial, and those that its script sets
    /log/SOURCE                              TextLog; the source is student, given_node (the exercise's own), grader or
                                             verdicts
    /checks/ID                               StateChange, written after scoring
    properties                               run, endpoints, result: what is known about the run as a whole

Source: Rerun, "The Entity Path Hierarchy".
"""

from __future__ import annotations

import contextlib
import math
import uuid
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
import rerun as rr
from rerun_bindings import flush_and_cleanup_orphaned_recordings

from gz_course.grader.record.blueprint import blueprint
from gz_course.grader.record.timeline import TIMELINE

APPLICATION = "gz_course"
BLOCK_NS = 5_000_000_000  # simulated time per block [ns]
PICTURE_NS = 500_000_000  # simulated time between two pictures of one camera [ns]


def part_of(path: Path) -> Path:
    """Return the name of a recording that is not finished yet."""
    return path.with_suffix(path.suffix + ".part")


class Recorder:
    """A recording being written. Not thread-safe: use it from one thread."""

    def __init__(self, path: Path, robot: str) -> None:
        """Write to `path`, which appears when the recorder is closed; the view follows the model `robot`."""
        self.path = path
        self.part = part_of(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        flush_and_cleanup_orphaned_recordings()  # the SDK keeps the threads of recordings that nobody uses any more
        self.stream = rr.RecordingStream(
            APPLICATION,
            recording_id=str(uuid.uuid4()),
            send_properties=False,
            batcher_config=rr.ChunkBatcherConfig.NEVER(),  # the default batches by wall time
        )
        self.stream.save(self.part, default_blueprint=blueprint(robot), write_footer=True)
        self._robot = robot
        self._tracks: dict[str, tuple[Any, Any]] = {}  # corners of the boxes in which models moved
        self.now_ns = 0
        self._named: set[str] = set()
        self._typed: set[str] = set()
        self._said: dict[str, str] = {}
        self._pictured: dict[str, int] = {}
        self._block_end = BLOCK_NS
        self._scalars: dict[str, tuple[list[int], list[float]]] = defaultdict(lambda: ([], []))
        self._poses: dict[str, tuple[list[int], list[Any], list[Any]]] = defaultdict(lambda: ([], [], []))
        self._texts: dict[str, tuple[list[int], list[str], list[str]]] = defaultdict(lambda: ([], [], []))
        self._arrays: dict[str, tuple[list[int], list[Any]]] = defaultdict(lambda: ([], []))
        self._points: dict[str, tuple[list[int], list[Any]]] = defaultdict(lambda: ([], []))
        self._pictures: dict[str, tuple[list[int], list[bytes]]] = defaultdict(lambda: ([], []))

    def set_time(self, now_ns: int) -> None:
        """Set simulated time to `now_ns` [ns] for everything logged from now on."""
        self.now_ns = now_ns
        if now_ns >= self._block_end:
            self.flush()
            self._block_end = now_ns - now_ns % BLOCK_NS + BLOCK_NS

    def scalar(self, entity: str, value: float) -> None:
        """Log one number. NaN is left out, because it makes equal recordings compare as different."""
        if not math.isnan(value):
            times, values = self._scalars[entity]
            times.append(self.now_ns)
            values.append(value)

    def pose(self, entity: str, position: Iterable[float], quaternion_wxyz: Iterable[float]) -> None:
        """Log a pose relative to the parent entity: position [m], unit quaternion."""
        times, positions, quaternions = self._poses[entity]
        times.append(self.now_ns)
        positions.append(tuple(position))
        w, x, y, z = quaternion_wxyz
        quaternions.append((x, y, z, w))
        if entity.count("/") == 2:  # a model, not its links
            place = positions[-1]
            low, high = self._tracks.get(entity, (place, place))
            self._tracks[entity] = (tuple(map(min, low, place)), tuple(map(max, high, place)))

    def text(self, entity: str, line: str, level: str = "INFO") -> None:
        times, lines, levels = self._texts[entity]
        times.append(self.now_ns)
        lines.append(line)
        levels.append(level)

    def said(self, entity: str, text: str) -> None:
        """Log the value of a text field of a message if it has changed; `Recording.lines` reads it."""
        if self._said.get(entity) != text:
            self._said[entity] = text
            self.text(entity, text)

    def wants_picture(self, entity: str) -> bool:
        """Return whether the last picture of this entity is old enough for another to be recorded."""
        return self.now_ns - self._pictured.get(entity, -PICTURE_NS) >= PICTURE_NS

    def picture(self, entity: str, jpeg: bytes) -> None:
        """Log a picture given as the bytes of a JPEG file."""
        self._pictured[entity] = self.now_ns
        times, pictures = self._pictures[entity]
        times.append(self.now_ns)
        pictures.append(jpeg)

    def array(self, entity: str, values: Iterable[float]) -> None:
        """Log a list of numbers as one row."""
        times, rows = self._arrays[entity]
        times.append(self.now_ns)
        rows.append(np.asarray(values, dtype=np.float64))

    def points(self, entity: str, positions: np.ndarray, at_ns: int | None = None) -> None:
        """Log a cloud of points (n, 3) [m], at the present time or at another one [ns]."""
        times, clouds = self._points[entity]
        times.append(self.now_ns if at_ns is None else at_ns)
        clouds.append(np.asarray(positions, dtype=np.float32))

    def name(self, entity: str, name: str) -> None:
        """Set the name a plot shows for a signal; the default is the last part of its entity."""
        if entity not in self._named:
            self._named.add(entity)
            self.static(entity, rr.SeriesLines(names=name))

    def typed(self, entity: str, ros_type: str) -> None:
        """Set the type of a topic's messages, such as `geometry_msgs/msg/Twist`."""
        if entity not in self._typed:
            self._typed.add(entity)
            self.static(entity, rr.AnyValues(ros_type=ros_type))

    def static(self, entity: str, archetype: Any) -> None:
        """Log a component that never changes, such as a shape."""
        self.stream.log(entity, archetype, static=True)
        self.stream.flush()

    def properties(self, name: str, **values: Any) -> None:
        """Store facts about the run as a whole."""
        self.stream.send_property(name, rr.AnyValues(**values))
        self.stream.flush()

    def flush(self) -> None:
        """Write everything collected so far to the file."""
        for entity, (times, values) in self._scalars.items():
            self._send(entity, times, rr.Scalars.columns(scalars=values))
        for entity, (times, positions, quaternions) in self._poses.items():
            columns = rr.Transform3D.columns(translation=positions, quaternion=quaternions)
            self._send(entity, times, columns)
        for entity, (times, lines, levels) in self._texts.items():
            self._send(entity, times, rr.TextLog.columns(text=lines, level=levels))
        for entity, (times, rows) in self._arrays.items():
            lengths = [len(row) for row in rows]
            flat = np.concatenate(rows)
            self._send(entity, times, rr.Scalars.columns(scalars=flat).partition(lengths))
        for entity, (times, clouds) in self._points.items():
            lengths = [len(cloud) for cloud in clouds]
            flat = np.concatenate(clouds)
            self._send(entity, times, rr.Points3D.columns(positions=flat).partition(lengths))
        for entity, (times, pictures) in self._pictures.items():
            columns = rr.EncodedImage.columns(blob=pictures, media_type=["image/jpeg"] * len(pictures))
            self._send(entity, times, columns)
        for pending in (self._scalars, self._poses, self._texts, self._arrays, self._points, self._pictures):
            pending.clear()
        self.stream.flush()

    def title(self, title: str) -> None:
        """Set the name under which the viewer lists the recording."""
        self.stream.send_recording_name(title)
        self.stream.flush()

    def tell_story(self, failures: Sequence[float]) -> None:
        """Set the layout in which the viewer opens the recording; `failures` are when checks failed [s]."""
        widest = max(self._tracks.values(), key=lambda box: math.dist(*box), default=None)
        track = self._tracks.get(f"/world/{self._robot}", widest)  # a run may have robots of another name
        self.stream.send_blueprint(blueprint(self._robot, track, failures))

    def states(self, entity: str, times_ns: Sequence[int], states: Sequence[str]) -> None:
        """Log named states, each with the time [ns] at which it begins."""
        self._send(entity, times_ns, rr.StateChange.columns(state=states))

    def constant(self, entity: str, times_ns: Sequence[int], value: float) -> None:
        """Log a number with the same value at all given times [ns], such as the edge of a band."""
        self._send(entity, times_ns, rr.Scalars.columns(scalars=[value] * len(times_ns)))

    def _send(self, entity: str, times_ns: Sequence[int], columns: Any) -> None:
        times = rr.TimeColumn(TIMELINE, duration=np.asarray(times_ns, dtype="timedelta64[ns]"))
        self.stream.send_columns(entity, [times], columns)

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            self.close()
        else:
            self.abandon()

    @classmethod
    @contextlib.contextmanager
    def begun(cls, path: Path, robot: str) -> Iterator[Recorder]:
        """Yield a recorder and leave it open.

        If the body raises, or an interrupt arrives before it, the file is removed.
        """
        recorder = None
        try:
            recorder = cls(path, robot)
            yield recorder
        except BaseException:
            if recorder is not None:
                recorder.abandon()
            part_of(path).unlink(missing_ok=True)
            raise

    def close(self) -> None:
        """Finish the file and rename it from `.part` to its name."""
        self.flush()
        self.stream.disconnect()
        self.part.rename(self.path)

    def abandon(self) -> None:
        """Stop writing and remove the unfinished file."""
        self.stream.disconnect()
        self.part.unlink(missing_ok=True)
