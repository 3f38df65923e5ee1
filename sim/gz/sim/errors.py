"""What can go wrong with a world, said in one sentence that names the file, the line and the nearest valid
name.

Used by the SDF reader, the model builder, the systems and the `gz sim` command.
"""

from __future__ import annotations

import difflib
import logging
from collections.abc import Iterable
from dataclasses import dataclass, field

LOG = logging.getLogger("gz.sim")


class SimError(Exception):
    """Base of everything this package raises on purpose; its text is one sentence fit for a student."""


class SdfError(SimError, ValueError):
    """An SDF file that cannot be run. The text starts with `file:line:`."""


class ResourceError(SdfError, FileNotFoundError):
    """A world, model or mesh file that was not found. The text names the nearest file that exists."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


def nearest(name: str, known: Iterable[str], *, listing: str = "known names are") -> str:
    """Return the tail of a sentence that points to the closest of `known`, or lists them when none is
    close.
    """
    names = sorted(set(known))
    lowered: dict[str, str] = {}
    for each in names:
        lowered.setdefault(each.lower(), each)
    close = difflib.get_close_matches(name.lower(), list(lowered), n=1, cutoff=0.6)
    if close:
        return f"did you mean '{lowered[close[0]]}'?"
    if not names:
        return f"{listing}: none"
    shown = ", ".join(names[:12]) + (", ..." if len(names) > 12 else "")
    return f"{listing}: {shown}"


@dataclass
class Diagnostics:
    """Collects the warnings of one world; each distinct sentence is logged once and kept in `warnings`."""

    warnings: list[str] = field(default_factory=list)

    def warn(self, where: str, sentence: str) -> None:
        """Report `sentence` about the place `where` (`file:line`, or empty for the whole world)."""
        text = f"{where}: {sentence}" if where else sentence
        if text not in self.warnings:
            self.warnings.append(text)
            LOG.warning("%s", text)
