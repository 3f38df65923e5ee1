"""A submission as `intake.py` has read it, kept in memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Submission:
    """What a student handed in. `fault` is one sentence on why it cannot run; None if it can.

    `path` is what the user named, for display only; `main` is the name of the expected file in `files`: relative name
    -> content of everything that goes into the sandbox. `sha256` is that of the files that the
    exercise asks for. `explained` says whether its text is read for likely mistakes, which only feedback needs.
    `notes` say under which other names files were taken.
    """

    path: Path
    main: str
    sha256: str
    fault: str | None = None
    files: dict[str, bytes] = field(default_factory=dict, repr=False)
    explained: bool = True
    notes: tuple[str, ...] = ()
