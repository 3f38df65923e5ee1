"""Substitutions that make paths or look into the file system: joined paths, programs, files, the log folder."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import gz_course.sim.launch.logging as launch_logging
from gz_course.sim.launch.errors import nearest
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from gz_course.sim.launch.substitutions.substitution_failure import SubstitutionFailure


class PathJoinSubstitution(Substitution):
    """Components joined with `/`. Each may be text, a substitution, or a list of them that is one component.

    `PathJoinSubstitution([...]) / "more"` adds a component.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        parts: Iterable[SomeSubstitutionsType]
        parts = [substitutions] if isinstance(substitutions, str | Substitution) else substitutions
        self.__components = [normalize_to_list_of_substitutions(part) for part in parts]

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The components."""
        return self.__components

    def __truediv__(self, component: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.__components, component])

    def describe(self) -> str:
        """`PathJoin('a', 'b')`."""
        return f"PathJoin({', '.join(describe_substitutions(part) for part in self.__components)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return os.path.join("", *[perform_substitutions(context, part) for part in self.__components])  # noqa: PTH118


class PathSubstitution(PathJoinSubstitution):
    """A path to which components are added with `/`."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])


class FindExecutable(Substitution):
    """The path of a program on PATH; SubstitutionFailure when there is none."""

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self.__name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name."""
        return self.__name

    def describe(self) -> str:
        """`FindExec('name')`."""
        return f"FindExec({describe_substitutions(self.__name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the path. Raises SubstitutionFailure with the nearest program."""
        name = perform_substitutions(context, self.__name)
        path = shutil.which(name, path=context.environment.get("PATH", os.defpath))
        if path is None:
            close = nearest_program(name, context)
            raise SubstitutionFailure(f"executable '{name}' not found on the PATH{close}")
        return path


def nearest_program(name: str, context: LaunchContext) -> str:
    """Return the end of a sentence that names the program on PATH whose name is nearest, empty if none is near."""
    known = []
    for folder in context.environment.get("PATH", os.defpath).split(os.pathsep):
        if folder and os.path.isdir(folder):  # noqa: PTH112
            known += os.listdir(folder)  # noqa: PTH208
    hint = nearest(name, known)
    return hint if "did you mean" in hint else ""


class FileContent(Substitution):
    """The text of a file; SubstitutionFailure when it cannot be read."""

    def __init__(self, path: Any) -> None:
        self.__path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """The path."""
        return self.__path

    def describe(self) -> str:
        """`FileContent('path')`."""
        return f"FileContent({describe_substitutions(self.__path)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        path = perform_substitutions(context, self.__path)
        try:
            return Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
            raise SubstitutionFailure(f"the file '{path}' cannot be read: {reason}") from None


class LaunchLogDir(Substitution):
    """The folder in which this run keeps its log files."""

    def describe(self) -> str:
        """`LaunchLogDir()`."""
        return "LaunchLogDir()"

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return launch_logging.launch_config.log_dir
