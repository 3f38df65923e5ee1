"""A submission as the grader holds it: read once, by `intake.py`, and from then on only in memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Submission:
    """What a student handed in. `fault` says in one sentence why it cannot run; None if it can.

    `path` is what the user named and is only shown; `main` is the file asked for, as it is called in `files`: relative
    name -> content of everything that goes into the box. `sha256` is that of the main file.
    """

    path: Path
    main: str
    sha256: str
    fault: str | None = None
    files: dict[str, bytes] = field(default_factory=dict, repr=False)
