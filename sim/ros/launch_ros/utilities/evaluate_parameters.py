"""Parameters whose substitutions are performed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch_ros.parameter_values import flattened
from gz_course.sim.ros.launch_ros.utilities.normalize_parameters import normalize_parameters


def evaluate_parameters(context: LaunchContext, parameters: Iterable[Any]) -> tuple[Path | dict[str, Any] | Any, ...]:
    """Return paths of files, and dicts of values by name; a Parameter becomes a dict of one."""
    result: list[Any] = []
    for each in normalize_parameters(parameters):
        if isinstance(each, Mapping):
            result.append(flattened(context, each))
        else:
            value = each.evaluate(context)
            result.append(dict([value]) if isinstance(value, tuple) else value)
    return tuple(result)
