"""Attributes that are true or false when the file is read: `<group scoped=>`, `<node shell= emulate_tty=>`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import gz_course.sim.ros.launch.logging as launch_logging

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend.entity import Entity


def read_flag(entity: Entity, name: str) -> dict[str, bool]:
    """Return the attribute as an option of its action, nothing without it.

    Text that is neither true nor false, also that of a substitution, counts as true if there is any, with a warning.
    Source: ros2/launch, branch jazzy: `GroupAction.parse` and `ExecuteProcess.parse` ask whether the text is empty
    """
    value = entity.get_attr(name, data_type=bool, optional=True)
    if isinstance(value, str):
        path, place = entity.place(name)
        meaning = "true" if value else "false"
        launch_logging.get_logger("launch").warning(
            f"{path}:{place}: '{name}' of {entity.described()} is the text {value!r}, which counts as {meaning} "
            "whatever it says; write true or false without quotes and substitutions"
        )
    return {} if value is None else {name: bool(value)}
