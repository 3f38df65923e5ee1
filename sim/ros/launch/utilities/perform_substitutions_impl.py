"""Converts substitutions to text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from gz_course.sim.ros.launch.substitution import Substitution

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext


def perform_substitutions(context: LaunchContext, substitutions: Iterable[Substitution]) -> str:
    return "".join([context.perform_substitution(each) for each in substitutions])
