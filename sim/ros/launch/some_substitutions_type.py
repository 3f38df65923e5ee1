"""The argument type of actions and substitutions for text, a substitution or a list of both."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Union

from gz_course.sim.ros.launch.substitution import Substitution

SomeSubstitutionsType = Union[str, Substitution, Iterable[Union[str, Substitution]]]  # noqa: UP007 - of the public API
SomeSubstitutionsType_types_tuple = (str, Substitution, Iterable)
