"""What a reader has done in a chapter, kept beside its notebook: steps that are done, and predictions."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from typing import Any

from gz_course.grader.process.whole_file import write_whole

NAME = ".progress.json"
STEPS, PREDICTIONS = "steps", "predictions"


class Kept:
    """The file of one chapter. What cannot be read counts as empty, and what cannot be written is not kept."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        self._all = _read(self._path)

    def steps(self) -> set[str]:
        """Return the names of the steps that are done."""
        return {name for name, done in self._all[STEPS].items() if done is True}

    def prediction(self, name: str) -> str | None:
        """Return what was predicted, in words."""
        said = self._all[PREDICTIONS].get(name)
        return said if isinstance(said, str) else None

    def keep(self, part: str, name: str, value: bool | str) -> None:
        """Keep a step (done or not) or a prediction."""
        if self._all[part].get(name) != value:
            self._all[part][name] = value
            with contextlib.suppress(OSError):
                write_whole(self._path, (json.dumps(self._all, indent=1, ensure_ascii=False) + "\n").encode())


def _read(path: Path) -> dict[str, dict[str, Any]]:
    empty: dict[str, dict[str, Any]] = {STEPS: {}, PREDICTIONS: {}}
    try:
        found = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return empty
    if not isinstance(found, dict):
        return empty
    return empty | {part: found[part] for part in empty if isinstance(found.get(part), dict)}
