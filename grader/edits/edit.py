"""An edit: what one is, and how those of a file are found."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib import import_module
from typing import NamedTuple

LONGEST = 60  # [characters] shown of a place
BY_SUFFIX = {"py": "python", "yaml": "yaml", "yml": "yaml"}
BY_SUFFIX |= {each: "xml" for each in ("xml", "xacro", "urdf", "sdf", "launch")}
MISSPELLED = {"name", "text", "type"}  # a text without its last letter breaks a program, and mends none


@dataclass(frozen=True)
class Edit:
    """A file in which `now` replaces `was` in `line`. `operator` names the type of fault: `sign`, `qos`, ..."""

    file: str
    line: int
    operator: str
    was: str
    now: str
    content: bytes = field(repr=False)
    begin: int = 0  # offset [bytes] of `was`

    @property
    def end(self) -> int:
        """Offset [bytes] of the end of `was`."""
        return self.begin + len(self.was.encode())

    @property
    def change(self) -> str:
        """The edit in one line, as `expect.toml` names it: `24: 0.1 -> 0.2`."""
        return f"{self.line}: {_short(self.was)} -> {_short(self.now)}"


class Vocabulary(NamedTuple):
    """What a right program may be made of: numbers and texts of the task, topics and types of its graph."""

    numbers: tuple[float, ...] = ()  # that failed checks ask for, or the task names
    ratios: tuple[float, ...] = ()  # of what a check asks for to what it measured
    topics: tuple[str, ...] = ()
    types: tuple[str, ...] = ()  # such as std_msgs/msg/String
    texts: tuple[str, ...] = ()


def both(original: bytes, first: Edit, second: Edit) -> bytes | None:
    """Return a file with two edits of it, None if they are at the same place."""
    first, second = sorted((first, second), key=lambda each: each.begin)
    if first.file != second.file or first.end > second.begin:
        return None
    between = original[first.end : second.begin]
    return original[: first.begin] + first.now.encode() + between + second.now.encode() + original[second.end :]


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def edits_of(file: str, content: bytes, vocabulary: Vocabulary | None = None) -> list[Edit]:
    """Return the edits of a file in the order of its lines; none for a type of file that is not known.

    Without a vocabulary they are those that break a right program; with one, also those that could mend a wrong one.
    A file that is not UTF-8, or cannot be read as what its name says, has none.
    """
    room = BY_SUFFIX.get(file.rpartition(".")[2])
    if room is None or not _is_utf8(content):
        return []
    module = import_module(f"gz_course.grader.edits.{room}")
    text = Text(file, content)
    found: list[Edit] = module.breaking(text)
    if vocabulary is not None:
        found = [each for each in found if each.operator not in MISSPELLED] + module.mending(text, vocabulary)
    once = {edit.content: edit for edit in reversed(found) if edit.content != content}
    return sorted(once.values(), key=lambda edit: (edit.line, edit.change))


def _is_utf8(content: bytes) -> bool:
    try:
        content.decode()
    except UnicodeDecodeError:
        return False
    return True


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

    def line_of(self, offset: int) -> int:
        """Return the line of an offset [bytes]."""
        return self.content.count(b"\n", 0, offset) + 1

    def edit(self, operator: str, line: int, begin: int, end: int, now: str) -> Edit:
        """Return the edit in which the bytes from `begin` to `end` are replaced."""
        was = self.content[begin:end].decode(errors="replace")
        content = self.content[:begin] + now.encode() + self.content[end:]
        return Edit(self._file, line, operator, was, now, content, begin)
