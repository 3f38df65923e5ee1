"""Questions about the class of an object."""

from __future__ import annotations

from typing import Any


def is_a(obj: Any, entity_type: type) -> bool:
    """Return whether an object is an instance of exactly or at least this class."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: Any, entity_type: type) -> bool:
    """Return whether an object, or a class, is of this class or one below it."""
    return issubclass(obj, entity_type) if isinstance(obj, type) else isinstance(obj, entity_type)
