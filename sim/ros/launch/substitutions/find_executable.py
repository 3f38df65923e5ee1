"""The substitution that finds a program on PATH."""

from __future__ import annotations

import os
import shutil

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class FindExecutable(Substitution):
    """The path of the program `name` on PATH."""

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    def describe(self) -> str:
        return f"FindExec({describe_substitutions(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the path. Raises SubstitutionFailure with the nearest program."""
        name = perform_substitutions(context, self.name)
        path = shutil.which(name, path=context.environment.get("PATH", os.defpath))
        if path is None:
            close = nearest_program(name, context)
            raise SubstitutionFailure(f"executable '{name}' not found on the PATH{close}")
        return path


def nearest_program(name: str, context: LaunchContext) -> str:
    """Return the end of a sentence that names the most similar program on PATH, empty if none is similar."""
    known = []
    for folder in context.environment.get("PATH", os.defpath).split(os.pathsep):
        if folder and os.path.isdir(folder):  # noqa: PTH112
            known += os.listdir(folder)  # noqa: PTH208
    return did_you_mean(name, known)
