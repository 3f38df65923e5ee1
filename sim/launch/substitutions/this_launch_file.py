"""Where the launch file that is being executed stands, and other values that belong to the moment."""

from __future__ import annotations

import getpass
import os
import random
import socket

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

CURRENT_FILE = "current_launch_file_path"
CURRENT_FOLDER = "current_launch_file_directory"
_ANONYMOUS_NAMES = "anon_names"


class ThisLaunchFile(Substitution):
    """The path of the launch file."""

    def describe(self) -> str:
        """`ThisLaunchFile()`."""
        return "ThisLaunchFile()"

    def perform(self, context: LaunchContext) -> str:
        """Return the path. Raises SubstitutionFailure outside of a launch file."""
        return _local(context, CURRENT_FILE, "ThisLaunchFile is used outside of a launch file")


class ThisLaunchFileDir(Substitution):
    """The folder of the launch file; in an included file: that file's folder."""

    def describe(self) -> str:
        """`ThisLaunchFileDir()`."""
        return "ThisLaunchFileDir()"

    def perform(self, context: LaunchContext) -> str:
        """Return the path. Raises SubstitutionFailure outside of a launch file."""
        return _local(context, CURRENT_FOLDER, "ThisLaunchFileDir is used outside of a launch file")


class LocalSubstitution(Substitution):
    """A part of `context.locals`, for example "event.returncode" in an event handler's actions."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.__expression = expression
        self.__description = description

    @property
    def expression(self) -> str:
        """The attributes, separated by dots."""
        return self.__expression

    def describe(self) -> str:
        """The description, or `LocalVar('expression')`."""
        return f"LocalVar('{self.__description or self.__expression}')"

    def perform(self, context: LaunchContext) -> str:
        """Return the value as text. Raises SubstitutionFailure."""
        name, *attributes = self.__expression.split(".")
        value = _local(context, name, f"there is no '{name}' in the launch file's locals")
        for attribute in attributes:
            if not hasattr(value, attribute):
                known = nearest(attribute, [each for each in dir(value) if not each.startswith("_")])
                raise SubstitutionFailure(f"{type(value).__name__} has no '{attribute}'{known}")
            value = getattr(value, attribute)
        return value if isinstance(value, str) else str(value)


class AnonName(Substitution):
    """A name that nobody else uses; the same one for the same `name` in one run."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.__name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name it begins with."""
        return self.__name

    def describe(self) -> str:
        """`AnonName('name')`."""
        return f"AnonName({describe_substitutions(self.__name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return `<name>_<user>_<host>_<process>_<number>`, fit for a node's name."""
        name = perform_substitutions(context, self.__name)
        known: dict[str, str] = context.get_locals_as_dict().get(_ANONYMOUS_NAMES, {})
        if name not in known:
            text = f"{name}_{_user()}_{socket.gethostname()}_{os.getpid()}_{random.randrange(2**31)}"
            known[name] = "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in text)
            context.extend_globals({_ANONYMOUS_NAMES: known})
        return known[name]


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return str(os.getuid())


def _local(context: LaunchContext, name: str, otherwise: str) -> str:
    known = context.get_locals_as_dict()
    if name not in known:
        raise SubstitutionFailure(otherwise)
    return known[name]
