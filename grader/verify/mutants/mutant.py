"""Mutants: what one is, how those of a file are found, and which few of them are graded."""

from __future__ import annotations

import hashlib
from collections import defaultdict
from dataclasses import dataclass, field
from importlib import import_module
from itertools import zip_longest

MOST = 12  # mutants of one solution that are graded
LONGEST = 60  # [characters] shown of a place
BY_SUFFIX = {"py": "python", "yaml": "yaml", "yml": "yaml"}


@dataclass(frozen=True)
class Mutant:
    """A file in which `now` replaces `was` in `line`. `operator` names the type of fault: `sign`, `qos`, ..."""

    file: str
    line: int
    operator: str
    was: str
    now: str
    content: bytes = field(repr=False)

    @property
    def change(self) -> str:
        """The mutant in one line, as `expect.toml` names it: `24: 0.1 -> 0.2`."""
        return f"{self.line}: {_short(self.was)} -> {_short(self.now)}"


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def mutants_of(file: str, content: bytes) -> list[Mutant]:
    """Return every mutant of a file, in the order of its lines; none for a type of file that cannot be mutated."""
    sort = BY_SUFFIX.get(file.rpartition(".")[2])
    if sort is None:
        return []
    found: list[Mutant] = import_module(f"gz_course.grader.verify.mutants.{sort}").mutants(file, content)
    once = {mutant.content: mutant for mutant in reversed(found) if mutant.content != content}
    return sorted(once.values(), key=lambda mutant: (mutant.line, mutant.change))


def choose(mutants: list[Mutant], most: int) -> list[Mutant]:
    """Return at most `most` of them by a fixed rule, in the order of their lines.

    The rule takes one of each operator, then a second of each, and so on; within an operator the order is that of the
    hashes of the changes, so that neither the beginning nor the end of a file is preferred.
    """
    by_operator: dict[str, list[Mutant]] = defaultdict(list)
    for mutant in sorted(mutants, key=_hash):
        by_operator[mutant.operator].append(mutant)
    rounds = zip_longest(*(by_operator[name] for name in sorted(by_operator)))
    chosen = [mutant for each in rounds for mutant in each if mutant is not None][:most]
    return sorted(chosen, key=lambda mutant: (mutant.line, mutant.change))


def _hash(mutant: Mutant) -> str:
    return hashlib.sha256(f"{mutant.was} -> {mutant.now} {mutant.line}".encode()).hexdigest()


class Text:
    """A file's bytes in which places are replaced; `line` counts from 1, `column` in bytes from 0, as in `ast`."""

    def __init__(self, file: str, content: bytes) -> None:
        self._file = file
        self.content = content
        self._starts = [0]
        for row in content.split(b"\n"):
            self._starts.append(self._starts[-1] + len(row) + 1)

    def at(self, line: int, column: int) -> int:
        """Return the offset [bytes] of a place."""
        return self._starts[line - 1] + column

    def mutant(self, operator: str, line: int, begin: int, end: int, now: str) -> Mutant:
        """Return the mutant in which the bytes from `begin` to `end` are replaced."""
        was = self.content[begin:end].decode(errors="replace")
        content = self.content[:begin] + now.encode() + self.content[end:]
        return Mutant(self._file, line, operator, was, now, content)
