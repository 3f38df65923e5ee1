"""Mutants of a YAML file: a changed name, type, direction, number or switch, a forgotten entry or key.

As in `python.py`, only the mutated place changes.
"""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from gz_course.grader.verify.mutants.mutant import Mutant, Text

DIRECTIONS = {"GZ_TO_ROS": "ROS_TO_GZ", "ROS_TO_GZ": "GZ_TO_ROS", "BIDIRECTIONAL": "GZ_TO_ROS"}
SWITCHES = {"true": "false", "false": "true"}


def mutants(file: str, content: bytes) -> list[Mutant]:
    root = yaml.compose(content.decode())
    return list(_within(_Marks(Text(file, content)), root)) if root is not None else []


class _Marks:
    """Converts PyYAML's marks, which count characters, to places in the bytes."""

    def __init__(self, text: Text) -> None:
        self._text = text
        self._whole = text.content.decode()

    def mutant(self, operator: str, begin: yaml.Mark, end: int, now: str) -> Mutant:
        """Return the mutant in which the text from a mark to an index is replaced."""
        first, last = (len(self._whole[:index].encode()) for index in (begin.index, end))
        return self._text.mutant(operator, begin.line + 1, first, last, now)

    def before_line(self, mark: yaml.Mark) -> int:
        """Return the index at which the line of a mark begins."""
        return self._whole.rfind("\n", 0, mark.index) + 1


def _within(marks: _Marks, node: yaml.Node) -> Iterator[Mutant]:
    if isinstance(node, yaml.SequenceNode):
        for item in node.value:
            if not node.flow_style and len(node.value) > 1:
                yield _forgotten_item(marks, node, item)
            yield from _within(marks, item)
    elif isinstance(node, yaml.MappingNode):
        for _, value in node.value:
            yield from _within(marks, value)
    elif isinstance(node, yaml.ScalarNode):
        yield from _scalar(marks, node)


def _forgotten_item(marks: _Marks, node: yaml.SequenceNode, item: yaml.Node) -> Mutant:
    """Return the mutant without one entry of a list."""
    place = node.value.index(item)
    begin = item.start_mark
    # An entry begins with the dash before it, and ends where the next one's line begins.
    if place + 1 < len(node.value):
        end = node.value[place + 1].start_mark.index
        return marks.mutant("forgotten", begin, end, "")
    before = node.value[place - 1]
    return marks.mutant("forgotten", before.start_mark, begin.index, "")


def _scalar(marks: _Marks, node: yaml.ScalarNode) -> Iterator[Mutant]:
    value, end = node.value, node.end_mark.index
    if value in DIRECTIONS:
        yield marks.mutant("direction", node.start_mark, end, DIRECTIONS[value])
    elif node.tag == "tag:yaml.org,2002:bool":
        yield marks.mutant("switch", node.start_mark, end, SWITCHES.get(value.lower(), "false"))
    elif node.tag in ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float"):
        number = yaml.safe_load(value)
        yield marks.mutant("number", node.start_mark, end, repr(2 * number if number else 1))
    elif node.tag == "tag:yaml.org,2002:str" and len(value) > 1:
        operator = "type" if "/msg/" in value or ".msgs." in value else "name"
        quoted = value[:-1] if node.style is None else repr(value[:-1])
        yield marks.mutant(operator, node.start_mark, end, quoted)
