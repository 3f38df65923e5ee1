"""A piece of text that is known only when the launch file runs.

The base of everything in `launch.substitutions`. Actions store what the user gave them as tuples of substitutions
(`normalize_to_list_of_substitutions`) and turn them into text when they are executed (`perform_substitutions`).
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Union

from gz_course.sim.launch.errors import NotTextError

if TYPE_CHECKING:
    from gz_course.sim.launch.launch_context import LaunchContext


class Substitution:
    """Text to be: `perform` computes it. A class of one's own overrides `perform` and `describe`."""

    def perform(self, context: LaunchContext) -> str:
        """Return the text. Raises SubstitutionFailure, or another LaunchError."""
        raise NotImplementedError(f"{type(self).__name__} does not say how it is performed")

    def describe(self) -> str:
        """Return a short form for `ros2 launch --show-args` and `--print`."""
        return repr(self)


SomeSubstitutionsType = Union[str, Substitution, Iterable[Union[str, Substitution]]]  # noqa: UP007 - of the public API
SomeSubstitutionsType_types_tuple = (str, Substitution, Iterable)


def normalize_to_list_of_substitutions(subst: Any) -> list[Substitution]:
    """Return text, a substitution, a path or an iterable of them as a list of substitutions.

    Raises NotTextError (a TypeError) for anything else.
    """
    from gz_course.sim.launch.substitutions import TextSubstitution

    if isinstance(subst, Substitution):
        return [subst]
    if isinstance(subst, str):
        return [TextSubstitution(text=subst)]
    if isinstance(subst, os.PathLike):
        return [TextSubstitution(text=os.fspath(subst))]
    if isinstance(subst, Iterable) and not isinstance(subst, bytes | dict):
        return [part for item in subst for part in _normalize_item(item)]
    raise NotTextError(
        f"{subst!r} is of type {type(subst).__name__}; text, a substitution or a list of them is expected here"
    )


def _normalize_item(item: Any) -> list[Substitution]:
    if isinstance(item, str | Substitution | os.PathLike):
        return normalize_to_list_of_substitutions(item)
    raise NotTextError(
        f"{item!r} is of type {type(item).__name__} and stands in a list of text and substitutions; "
        f"write it as text: '{item}'"
    )


def perform_substitutions(context: LaunchContext, substitutions: Iterable[Substitution]) -> str:
    """Return the text of all of them, joined."""
    return "".join([context.perform_substitution(each) for each in substitutions])


def describe_substitutions(substitutions: Sequence[Substitution]) -> str:
    """Return their short forms, joined by ` + `, as `--show-args` prints them."""
    return " + ".join(each.describe() for each in substitutions) or "''"
