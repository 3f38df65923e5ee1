"""The action that runs a file with pytest."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitutions import FindExecutable
from gz_course.sim.ros.launch_testing.actions.test import Test


class PyTest(Test):
    """Runs the tests in the file `path`."""

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[FindExecutable(name="python3"), "-m", "pytest", path], **kwargs)
        self.path = path
