"""The action that selects the clock of all nodes of a scope."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch_ros.actions.set_parameter import SetParameter


class SetUseSimTime(SetParameter):
    """Sets the parameter use_sim_time of the following nodes: with True they use the time of /clock."""

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)
