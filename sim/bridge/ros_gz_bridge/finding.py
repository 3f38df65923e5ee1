"""Errors and warnings about the configuration of a bridge.

`config`, `arguments`, `parameters` and `checks` make them; `lint` and `parameter_bridge` print them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

_LONGEST = 600


@dataclass(frozen=True)
class Finding:
    """An error or a warning. `place` is `file:line`, or the name of the argument or parameter.

    Of an error, `tolerated` says that the original ros_gz_bridge makes the bridge all the same, and `fatal` that it
    ends; of other errors it leaves out the bridge. `parameter_bridge` does the same, unless it is `--strict`. `advice`
    marks what is no mistake of the author: a key that changes nothing, or a ROS package that is not installed here;
    `course grade` takes no points for it.
    """

    place: str
    sentence: str
    warning: bool = False
    tolerated: bool = False
    advice: bool = False
    fatal: bool = False

    def __str__(self) -> str:
        return f"{one_line(self.place)}: {one_line(self.sentence)}" if self.place else one_line(self.sentence)


class ConfigError(ValueError):
    """A configuration with errors; `errors` holds one sentence for each, with its place."""

    def __init__(self, errors: Iterable[str]) -> None:
        self.errors = list(errors)
        super().__init__("\n".join(self.errors))


def raise_errors(findings: Iterable[Finding]) -> None:
    """Raise ConfigError if any of `findings` is an error."""
    errors = [str(finding) for finding in findings if not finding.warning]
    if errors:
        raise ConfigError(errors)


def one_line(text: str) -> str:
    """Return `text` without line breaks, shortened to 600 characters; it may quote a file."""
    words = " ".join(text.split())
    return words if len(words) <= _LONGEST else f"{words[: _LONGEST // 2]} ... {words[-_LONGEST // 2 :]}"
