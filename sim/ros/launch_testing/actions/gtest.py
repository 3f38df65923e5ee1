"""The action that runs a test program made with GoogleTest."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch_testing.actions.test import Test


class GTest(Test):
    """Runs the program at `path`."""

    def __init__(self, *, path: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(cmd=[path], **kwargs)
        self.path = path
