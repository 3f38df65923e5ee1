"""Errors and warnings about a world: one sentence with the file, the line and the nearest valid name.

Used by the SDF reader, the model builder, the systems and the `gz sim` command.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.sdf.element import Element

LOG = logging.getLogger("gz.sim")
_MOST_WARNINGS = 1000
_LONGEST = 1000  # characters of one sentence


class SimError(Exception):
    """The base class of the errors that this package raises deliberately; the text is one sentence for the user."""


class SdfError(SimError, ValueError):
    """An SDF file that cannot be run; the text begins with `file:line:`. `element` is the one at fault, if known."""

    element: Element | None = None


class ResourceError(SdfError, FileNotFoundError):
    """A world, model or mesh file that was not found; the text names the nearest existing file."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


def one_line(sentence: str) -> str:
    """Return the sentence in one line and shortened, because it may quote the text of a file."""
    words = " ".join(sentence.split())
    return words if len(words) <= _LONGEST else f"{words[: _LONGEST // 2]} ... {words[-_LONGEST // 2 :]}"


@dataclass
class Diagnostics:
    """Collects the warnings of one world; each distinct sentence is logged once and kept in `warnings`.

    With `strict` nothing is logged during loading: `refuse`, called at its end, raises one error with all warnings.
    Later warnings are logged at once, except within `refusing`. A `doubt` never causes an error. What Gazebo does
    otherwise is no fault of a model: it is logged, and kept in `differences`. With `quiet` nothing is logged at all.
    With `lenient`, as in Gazebo, a plugin with a wrong parameter does not refuse the world.
    """

    warnings: list[str] = field(default_factory=list)
    differences: list[str] = field(default_factory=list)
    strict: bool = False
    quiet: bool = False
    lenient: bool = False
    _known: set[str] = field(default_factory=set, repr=False)
    _doubts: set[str] = field(default_factory=set, repr=False)

    def warn(self, where: str, sentence: str) -> None:
        """Report `sentence` about the place `where` (`file:line`, or empty for the whole world)."""
        self._report(where, sentence, doubt=False)

    def doubt(self, where: str, sentence: str) -> None:
        """Report something that is valid but probably a mistake."""
        self._report(where, sentence, doubt=True)

    def differs(self, where: str, sentence: str) -> None:
        """Report something that is valid, and that Gazebo does otherwise."""
        text = f"{where}: {one_line(sentence)}" if where else one_line(sentence)
        if text not in self.differences and len(self.differences) < _MOST_WARNINGS:
            self.differences.append(text)
            if not self.quiet:
                LOG.warning("%s", text)

    def _report(self, where: str, sentence: str, doubt: bool) -> None:
        text = f"{where}: {one_line(sentence)}" if where else one_line(sentence)
        if text in self._known or len(self._known) > _MOST_WARNINGS:
            return
        self._known.add(text)
        if len(self._known) > _MOST_WARNINGS:
            text = f"there are more than {_MOST_WARNINGS} warnings, the others are not shown"
        self.warnings.append(text)
        if doubt:
            self._doubts.add(text)
        if (doubt or not self.strict) and not self.quiet:
            LOG.warning("%s", text)

    def warn_once(self, subject: str, where: str, sentence: str) -> None:
        """Report `sentence` only for the first call with this `subject`."""
        if subject not in self._known and len(self._known) <= _MOST_WARNINGS:
            self._known.add(subject)
            self.warn(where, sentence)

    def __post_init__(self) -> None:
        self._strict_loading = self.strict

    @contextmanager
    def refusing(self) -> Iterator[None]:
        """Apply strict loading to a later operation, such as the creation of a model."""
        since, self.strict = len(self.warnings), self._strict_loading
        try:
            yield
        finally:
            refused, self.strict = self.warnings[since:], False
        self._refuse(refused if self._strict_loading else [])

    def refuse(self) -> None:
        """End strict loading. Raises SdfError with all collected warnings, one per line, if there are any."""
        strict, self.strict = self.strict, False
        self._refuse(self.warnings if strict else [])

    def _refuse(self, warnings: list[str]) -> None:
        refused = [text for text in warnings if text not in self._doubts]
        if refused:
            count = len(refused)
            first = f"strict loading refuses what would be {count} warning{'s' if count > 1 else ''}:"
            raise SdfError("\n  ".join((first, *refused)))
