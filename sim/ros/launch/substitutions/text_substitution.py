"""The substitution for plain text."""

from __future__ import annotations

from gz_course.sim.ros.launch.errors import NotTextError
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.substitution import Substitution


class TextSubstitution(Substitution):
    """The text `text`. Raises NotTextError (a TypeError) for anything but a str."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise NotTextError(f"TextSubstitution wants text, not {text!r} of type {type(text).__name__}")
        self.text = text

    def describe(self) -> str:
        return f"'{self.text}'"

    def perform(self, context: LaunchContext) -> str:
        return self.text
