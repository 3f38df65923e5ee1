"""The types of parameters in launch files, for annotations.

Source: ros2/launch_ros, launch_ros/launch_ros/parameters_type.py
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch_ros.parameter_descriptions import Parameter

SomeParameterFile = SomeSubstitutionsType | os.PathLike[str]
SomeParameterName = str | Sequence[Substitution | str]
SomeParameterValue = SomeSubstitutionsType | Sequence[SomeSubstitutionsType] | str | int | float | bool | bytes
SomeParameterValue_types_tuple = (*SomeSubstitutionsType_types_tuple, str, int, float, bool, bytes)
SomeParametersDict = Mapping[SomeParameterName, Any]
SomeParameters = Sequence[SomeParameterFile | Parameter | SomeParametersDict]
ParameterFile = Sequence[Substitution]
ParameterName = Sequence[Substitution]
ParameterValue = Any
ParametersDict = dict[ParameterName, ParameterValue]
Parameters = Sequence[ParameterFile | ParametersDict | Parameter]
EvaluatedParameterValue = str | int | float | bool | Sequence[str] | Sequence[int] | Sequence[float] | Sequence[bool]
EvaluatedParameters = Sequence[Path | Parameter | dict[str, EvaluatedParameterValue]]
