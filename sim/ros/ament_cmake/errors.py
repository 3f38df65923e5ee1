"""What is wrong with a package that is built."""

from __future__ import annotations

from pathlib import Path


class PackageError(Exception):
    """A package that cannot be built; its text is one sentence with file and line."""

    def __init__(self, sentence: str, path: Path | str, line: int | None = None) -> None:
        super().__init__(at(path, line, sentence))


def at(path: Path | str, line: int | None, sentence: str) -> str:
    """Return a sentence with its place before it."""
    return f"{path}:{line}: {sentence}" if line else f"{path}: {sentence}"
