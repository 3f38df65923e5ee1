"""Parameters as Node takes them, checked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from gz_course.sim.ros.launch_ros.parameter_descriptions import Parameter, ParameterFile


def normalize_parameters(parameters: Iterable[Any]) -> list[Any]:
    """Return each item as a dict, Parameter or ParameterFile. Raises TypeError if this is no list."""
    if isinstance(parameters, str | Mapping) or not isinstance(parameters, Iterable):
        raise TypeError(f"parameters={parameters!r} is no list")
    kinds = (Mapping, Parameter, ParameterFile)
    return [each if isinstance(each, kinds) else ParameterFile(each) for each in parameters]
