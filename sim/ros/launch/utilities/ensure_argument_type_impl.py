"""The check of an argument's type."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


def ensure_argument_type(
    argument: Any, types: type | Iterable[type], argument_name: str, caller: str | None = None
) -> None:
    """Raise TypeError unless an argument is of one of these types, or is one of them itself."""
    kinds = (types,) if isinstance(types, type) else tuple(types)
    if isinstance(argument, kinds) or (isinstance(argument, type) and issubclass(argument, kinds)):
        return
    whose = "" if caller is None else f" of {caller}"
    wanted = " or ".join(getattr(kind, "__name__", str(kind)) for kind in kinds)
    raise TypeError(f"{argument_name}={argument!r}{whose} is of type {type(argument).__name__}; {wanted} is expected")
