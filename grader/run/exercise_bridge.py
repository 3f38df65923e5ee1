"""The bridge that comes with an exercise, for the kinds of submissions that do not bring their own."""

from __future__ import annotations

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import Exercise
from gz_course.sim.bridge.ros_gz_bridge.config import ConfigError, load_yaml
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry


def exercise_bridge(exercise: Exercise) -> list[BridgeEntry]:
    """Read the file `run.bridge` of a manifest. Raises ManifestError if it is wrong."""
    assert exercise.bridge is not None
    try:
        return load_yaml(exercise.bridge)
    except (ConfigError, OSError) as error:
        raise ManifestError(str(error)) from None
