"""What is wrong with the text of an interface."""

from __future__ import annotations

from pathlib import Path


class InvalidInterfaceError(ImportError):
    """An interface whose classes cannot be made; its text is one sentence with file and line.

    It is an ImportError because it is seen where the interface is imported.
    """

    def __init__(self, sentence: str, path: Path | str, line: int | None = None) -> None:
        place = f"{path}:{line}" if line else str(path)
        super().__init__(f"{place}: {sentence}", path=str(path))
        self.sentence = sentence
        self.line = line
