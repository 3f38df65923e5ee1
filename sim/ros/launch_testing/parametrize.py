"""The decorator that runs a test description once for each of several arguments."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator
from typing import Any

Description = Callable[..., Any]


def parametrize(
    argnames: str, argvalues: Iterable[Any]
) -> Callable[[Description], Callable[[], Iterator[tuple[Description, dict[str, Any]]]]]:
    """Launch a test description for each of `argvalues`; `argnames` are the names of its arguments, with commas.

    Tests may take arguments of these names, too.
    """
    names = [name.strip() for name in argnames.split(",") if name.strip()]
    rows = [value if isinstance(value, tuple) else (value,) for value in argvalues]

    def decorate(description: Description) -> Callable[[], Iterator[tuple[Description, dict[str, Any]]]]:
        @functools.wraps(description)
        def each() -> Iterator[tuple[Description, dict[str, Any]]]:
            for row in rows:
                arguments = dict(zip(names, row, strict=False))
                with_arguments = functools.partial(description, **arguments)
                yield functools.update_wrapper(with_arguments, description), arguments

        each.__parametrized__ = True  # type: ignore[attr-defined]
        return each

    return decorate
