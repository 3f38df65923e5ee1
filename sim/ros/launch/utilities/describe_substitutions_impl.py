"""The short form of substitutions, for `ros2 launch --show-args` and `--print`."""

from __future__ import annotations

from collections.abc import Sequence

from gz_course.sim.ros.launch.substitution import Substitution


def describe_substitutions(substitutions: Sequence[Substitution]) -> str:
    """Return their short forms, joined by ` + `."""
    return " + ".join(each.describe() for each in substitutions) or "''"
