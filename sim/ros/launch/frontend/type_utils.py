"""The question whether an attribute is a list of elements."""

from __future__ import annotations

from typing import Any, get_args, get_origin

from gz_course.sim.ros.launch.frontend.entity import Entity


def check_is_list_entity(data_type: Any) -> bool:
    """Return whether this is `List[Entity]`, of any class of entities."""
    arguments = get_args(data_type)
    return get_origin(data_type) is list and isinstance(arguments[0], type) and issubclass(arguments[0], Entity)
