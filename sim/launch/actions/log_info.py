"""Writes a line."""

from __future__ import annotations

from typing import Any

import gz_course.sim.launch.logging as launch_logging
from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class LogInfo(Action):
    """Prints `[INFO] [launch.user]: msg`."""

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__msg = normalize_to_list_of_substitutions(msg)

    @property
    def msg(self) -> list[Substitution]:
        """The message."""
        return self.__msg

    def describe(self) -> str:
        """Return one line for `ros2 launch --print`."""
        return f"LogInfo({describe_substitutions(self.__msg)})"

    def execute(self, context: LaunchContext) -> None:
        """Print the message."""
        launch_logging.get_logger("launch.user").info(perform_substitutions(context, self.__msg))
