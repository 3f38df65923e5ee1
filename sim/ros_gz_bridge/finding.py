"""What is wrong with a configuration: one sentence, its place, and whether the bridge can start all the same.

Made by ``config``, ``arguments``, ``parameters`` and ``checks``; shown by ``lint`` and ``parameter_bridge``.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

_LONGEST = 600


@dataclass(frozen=True)
class Finding:
    """One fault. ``place`` is ``file:line`` or the argument or parameter it was found in.

    A ``warning`` stops nothing. ``tolerated`` marks an error that the original ros_gz_bridge passes over and
    bridges all the same; with ``--compat`` such an error is only a warning.
    """

    place: str
    sentence: str
    warning: bool = False
    tolerated: bool = False

    def __str__(self) -> str:
        return f"{one_line(self.place)}: {one_line(self.sentence)}" if self.place else one_line(self.sentence)


class ConfigError(ValueError):
    """One or more faults in a configuration; ``errors`` holds one sentence for each, with its place."""

    def __init__(self, errors: Iterable[str]) -> None:
        self.errors = list(errors)
        super().__init__("\n".join(self.errors))


def raise_errors(findings: Iterable[Finding]) -> None:
    """Raise ``ConfigError`` if any of ``findings`` is an error."""
    errors = [str(finding) for finding in findings if not finding.warning]
    if errors:
        raise ConfigError(errors)


def one_line(text: str) -> str:
    """``text`` without line breaks and at most 600 characters long, whatever it quotes."""
    words = " ".join(text.split())
    return words if len(words) <= _LONGEST else f"{words[: _LONGEST // 2]} ... {words[-_LONGEST // 2 :]}"
