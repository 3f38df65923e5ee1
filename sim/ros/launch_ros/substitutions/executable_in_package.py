"""The substitution for the path of an executable of a ROS package."""

from __future__ import annotations

import os
from pathlib import Path

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitutions import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from gz_course.sim.ros.launch_ros.substitutions.find_package import FindPackagePrefix


class ExecutableInPackage(FindPackagePrefix):
    """`<prefix>/lib/<package>/<executable>`; SubstitutionFailure with the nearest name if it does not exist."""

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        super().__init__(package)
        self.executable = normalize_to_list_of_substitutions(executable)

    def describe(self) -> str:
        package, executable = describe_substitutions(self.package), describe_substitutions(self.executable)
        return f"ExecInPkg(pkg={package}, exec={executable})"

    def perform(self, context: LaunchContext) -> str:
        executable = perform_substitutions(context, self.executable)
        package = perform_substitutions(context, self.package)
        prefix = Path(self.find(package))
        folder = prefix / "lib" / package
        if not folder.is_dir():
            raise SubstitutionFailure(
                f"package '{package}' found at '{prefix}', but libexec directory '{folder}' does not exist"
            )
        path = folder / executable
        if path.is_file() and os.access(path, os.X_OK):
            return str(path)
        if path.is_file():
            raise SubstitutionFailure(f"'{path}' is not executable; chmod +x makes it so")
        known = [each.name for each in folder.iterdir() if each.is_file() and os.access(each, os.X_OK)]
        hint = did_you_mean(executable, known, listing="there are")
        raise SubstitutionFailure(f"executable '{executable}' not found on the libexec directory '{folder}'{hint}")
