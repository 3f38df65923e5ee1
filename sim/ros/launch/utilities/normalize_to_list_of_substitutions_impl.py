"""Converts users' arguments to substitutions."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

from gz_course.sim.ros.launch.errors import NotTextError
from gz_course.sim.ros.launch.substitution import Substitution


def normalize_to_list_of_substitutions(subst: Any) -> list[Substitution]:
    """Return text, a substitution, a path or an iterable of them as a list of substitutions.

    Raises NotTextError (a TypeError) for anything else.
    """
    from gz_course.sim.ros.launch.substitutions.text_substitution import TextSubstitution

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
