"""The substitution for a unique name."""

from __future__ import annotations

import getpass
import os
import random
import socket

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_ANONYMOUS_NAMES = "anon_names"


class AnonName(Substitution):
    """A unique name, the same one for the same `name` within a run."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    def describe(self) -> str:
        return f"AnonName({describe_substitutions(self.name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return `<name>_<user>_<host>_<process>_<number>`, a valid node name."""
        name = perform_substitutions(context, self.name)
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
