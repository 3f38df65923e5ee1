"""A substitution that is made of a file: reads it, with errors that name it, and writes what becomes of it."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import yaml

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class OfSourceFile(Substitution):
    """The base of substitutions whose first argument is a file; `name` is its path."""

    def __init__(self, source_file: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(source_file)

    def describe(self) -> str:
        return f"{type(self).__name__}({describe_substitutions(self.name)})"

    def _text(self, context: LaunchContext) -> str:
        """Return the text of the file. Raises SubstitutionFailure if it cannot be read."""
        path = perform_substitutions(context, self.name)
        try:
            return Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
            raise SubstitutionFailure(f"{type(self).__name__}: the file '{path}' cannot be read: {reason}") from None

    def _parameters(self, context: LaunchContext) -> dict[str, Any]:
        """Return the content of the parameter file. Raises SubstitutionFailure if it is no YAML dictionary."""
        text, path = self._text(context), perform_substitutions(context, self.name)
        try:
            content = yaml.safe_load(text)
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            place = path if mark is None else f"{path}:{mark.line + 1}"
            raise SubstitutionFailure(f"{place}: this is no YAML: {getattr(error, 'problem', error)}") from None
        if content is not None and not isinstance(content, dict):
            raise SubstitutionFailure(
                f"{path}: a parameter file is a dictionary with names of nodes; this is a {type(content).__name__}"
            )
        return content or {}


def performed(context: LaunchContext, texts: dict[str, list[Substitution]]) -> dict[str, str]:
    return {name: perform_substitutions(context, value) for name, value in texts.items()}


def as_texts(texts: dict[str, SomeSubstitutionsType] | None) -> dict[str, list[Substitution]]:
    return {name: normalize_to_list_of_substitutions(value) for name, value in (texts or {}).items()}


def written(text: str) -> str:
    """Write a text to a new temporary file, which stays; return its path."""
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", delete=False) as file:
        file.write(text)
    return file.name
