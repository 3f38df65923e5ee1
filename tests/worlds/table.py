"""The table of worlds, `gz_sim_8.txt`: a line `NAME: OUTCOME` for each world, then its sentences, indented.

Outcomes: `loads` (without a word), `warns`, `refused`, `ended` (its process ended at a limit or by itself) and
`untried`. Sentences have no place (`file:line`); repeated ones stand once, in alphabetical order. The names are those
of the example and test worlds of gz-sim; `make worlds DIR=... WORLDS_OPTIONS=--write` adds what is missing.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

TABLE = Path(__file__).with_name("gz_sim_8.txt")
UNTRIED = "untried"
OUTCOMES = ("loads", "warns", "refused", "ended", UNTRIED)
_LONGEST = 240
_PLACE = re.compile(r"\S+:\d+: ")
_LISTING = re.compile(r"; systems that run here are: .*")


@dataclass(frozen=True)
class Outcome:
    """What a world does: one of `OUTCOMES`, and what is said about it."""

    kind: str
    sentences: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "\n    ".join((self.kind, *self.sentences))


def outcome(kind: str, said: list[str], folders: dict[str, str]) -> Outcome:
    """Return an outcome whose sentences have no places and no `folders`, which get the names given."""
    found = set()
    for text in said:
        for folder, name in folders.items():
            text = text.replace(folder, name)
        text = _LISTING.sub("", " ".join(_PLACE.sub("", text).split()))
        found.add(text if len(text) <= _LONGEST else f"{text[:_LONGEST]} ...")
    return Outcome(kind, tuple(sorted(found)))


def read(path: Path = TABLE) -> dict[str, Outcome]:
    """Return the outcomes by name. Raises ValueError for a line that is none."""
    worlds: dict[str, Outcome] = {}
    name = ""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("    ") and name:
            worlds[name] = Outcome(worlds[name].kind, (*worlds[name].sentences, line.strip()))
            continue
        name, _, kind = line.rpartition(": ")
        if not name or kind not in OUTCOMES:
            raise ValueError(f"{path.name}:{number}: expected 'NAME: OUTCOME' with one of {OUTCOMES}, got {line!r}")
        worlds[name] = Outcome(kind)
    return worlds


def write(worlds: dict[str, Outcome], path: Path = TABLE) -> None:
    """Write the table, sorted by name."""
    path.write_text("".join(f"{name}: {worlds[name]}\n" for name in sorted(worlds)), encoding="utf-8")
