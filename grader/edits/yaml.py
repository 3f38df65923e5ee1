"""Edits of a YAML file: a changed name, type, direction, number or switch, a forgotten entry or key.

As in `python.py`, only the edited place changes.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import yaml

from gz_course.grader.edits.edit import Edit, Text, Vocabulary
from gz_course.grader.edits.other import nearest, other_numbers

DIRECTIONS = {"GZ_TO_ROS": "ROS_TO_GZ", "ROS_TO_GZ": "GZ_TO_ROS", "BIDIRECTIONAL": "GZ_TO_ROS"}
SWITCHES = {"true": "false", "false": "true"}


def breaking(text: Text) -> list[Edit]:
    """Return the edits that break a right file."""
    root = _composed(text)
    return [*_within(_Marks(text), root)] if root is not None else []


def mending(text: Text, vocabulary: Vocabulary) -> list[Edit]:
    """Return further edits, which could mend a wrong file."""
    root = _composed(text)
    return [*_mended(_Marks(text), root, vocabulary)] if root is not None else []


def _composed(text: Text) -> yaml.Node | None:
    try:
        root: yaml.Node | None = yaml.compose(text.content.decode(), yaml.SafeLoader)
    except (yaml.YAMLError, UnicodeDecodeError, RecursionError):
        return None
    return root


class _Marks:
    """Converts PyYAML's marks, which count characters, to places in the bytes."""

    def __init__(self, text: Text) -> None:
        self._text = text
        self._whole = text.content.decode()

    def edit(self, operator: str, begin: yaml.Mark, end: int, now: str) -> Edit:
        """Return the edit in which the text from a mark to an index is replaced."""
        first, last = (len(self._whole[:index].encode()) for index in (begin.index, end))
        return self._text.edit(operator, begin.line + 1, first, last, now)

    def text(self, begin: int, end: int) -> str:
        """Return the text between two indices."""
        return self._whole[begin:end]


def _within(marks: _Marks, node: yaml.Node) -> Iterator[Edit]:
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


def _forgotten_item(marks: _Marks, node: yaml.SequenceNode, item: yaml.Node) -> Edit:
    """Return the edit without one entry of a list."""
    place = node.value.index(item)
    begin = item.start_mark
    # An entry begins with the dash before it, and ends where the next one's line begins.
    if place + 1 < len(node.value):
        end = node.value[place + 1].start_mark.index
        return marks.edit("forgotten", begin, end, "")
    before = node.value[place - 1]
    return marks.edit("forgotten", before.start_mark, begin.index, "")


def _scalar(marks: _Marks, node: yaml.ScalarNode) -> Iterator[Edit]:
    value, end = node.value, node.end_mark.index
    if value in DIRECTIONS:
        yield marks.edit("direction", node.start_mark, end, DIRECTIONS[value])
    elif node.tag == "tag:yaml.org,2002:bool":
        yield marks.edit("switch", node.start_mark, end, SWITCHES.get(value.lower(), "false"))
    elif node.tag in ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float"):
        number = yaml.safe_load(value)
        yield marks.edit("number", node.start_mark, end, repr(2 * number if number else 1))
    elif node.tag == "tag:yaml.org,2002:str" and len(value) > 1:
        operator = "type" if "/msg/" in value or ".msgs." in value else "name"
        quoted = value[:-1] if node.style is None else repr(value[:-1])
        yield marks.edit(operator, node.start_mark, end, quoted)


def _mended(marks: _Marks, node: yaml.Node, vocabulary: Vocabulary) -> Iterator[Edit]:
    if isinstance(node, yaml.SequenceNode):
        for item in node.value:
            yield from _mended(marks, item, vocabulary)
    elif isinstance(node, yaml.MappingNode):
        scalars = [value for _, value in node.value if isinstance(value, yaml.ScalarNode)]
        for first, second in itertools.pairwise(scalars):
            yield _exchanged(marks, first, second)
        for _, value in node.value:
            yield from _mended(marks, value, vocabulary)
    elif isinstance(node, yaml.ScalarNode):
        for operator, now in _other_scalars(node, vocabulary):
            yield marks.edit(operator, node.start_mark, node.end_mark.index, now)


def _exchanged(marks: _Marks, first: yaml.ScalarNode, second: yaml.ScalarNode) -> Edit:
    """Return the edit in which two values that follow each other have changed places."""
    begin, end = first.start_mark, second.end_mark.index
    a, b = (marks.text(each.start_mark.index, each.end_mark.index) for each in (first, second))
    between = marks.text(first.end_mark.index, second.start_mark.index)
    return marks.edit("exchanged", begin, end, f"{b}{between}{a}")


def _other_scalars(node: yaml.ScalarNode, vocabulary: Vocabulary) -> Iterator[tuple[str, str]]:
    """Yield what else a scalar could be, with the operator, the nearest first."""
    value = node.value
    if value in DIRECTIONS:
        yield from (("direction", each) for each in DIRECTIONS)
    elif node.tag in ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float"):
        yield from (("number", each) for each in other_numbers(yaml.safe_load(value), vocabulary))
    elif node.tag == "tag:yaml.org,2002:str":
        gazebo = tuple(each for each in vocabulary.types if each.startswith("gz."))
        ros = tuple(each for each in vocabulary.types if "/msg/" in each)
        known = ros if "/" in value[1:] and "msg" in value else gazebo if ".msgs." in value else vocabulary.topics
        operator = "name" if known is vocabulary.topics else "type"
        yield from ((operator, each) for each in nearest(value, known))
