"""The action that sets the clock of all nodes of a scope."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch_ros.actions.set_parameter import SetParameter


class SetUseSimTime(SetParameter):
    """An action that lets the nodes that follow take the time from /clock, or not: their parameter use_sim_time."""

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)
