"""The substitution for the text of a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class FileContent(Substitution):
    """The text of the file at `path`."""

    def __init__(self, path: Any) -> None:
        self.path = normalize_to_list_of_substitutions(path)

    def describe(self) -> str:
        return f"FileContent({describe_substitutions(self.path)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the text. Raises SubstitutionFailure when the file cannot be read."""
        path = perform_substitutions(context, self.path)
        try:
            return Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
            raise SubstitutionFailure(f"the file '{path}' cannot be read: {reason}") from None
