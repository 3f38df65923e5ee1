"""Text that is known already."""

from __future__ import annotations

from gz_course.sim.launch.errors import NotTextError
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.substitution import Substitution


class TextSubstitution(Substitution):
    """Stands for `text` itself. Raises NotTextError (a TypeError) for anything but a str."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise NotTextError(f"TextSubstitution wants text, not {text!r} of type {type(text).__name__}")
        self.__text = text

    @property
    def text(self) -> str:
        """The text."""
        return self.__text

    def describe(self) -> str:
        """The text in quotes."""
        return f"'{self.__text}'"

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        return self.__text
