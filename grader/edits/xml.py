"""Edits of an XML file (launch, SDF, URDF, xacro) that could mend it: numbers, texts, elements."""

from __future__ import annotations

import re
from collections.abc import Iterator

from gz_course.grader.edits.edit import Edit, Text, Vocabulary
from gz_course.grader.edits.other import nearest, other_numbers

NUMBER = re.compile(rb"(?<![\w.{$])[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.])")
EXPRESSION = re.compile(rb"\$\{\s*([\w.]+)\s*([-+*/])\s*([\w.]+)\s*\}")
VALUE = re.compile(rb"""(?<==")[^"<>]+(?=")|(?<=>)[^<>\s][^<>]*(?=<)""")
LEAF = re.compile(rb"<(\w+)\b[^<>]*/>|<(\w+)\b[^<>]*(?<!/)>[^<>]*</\2>")
SWITCHES = {b"true": "false", b"false": "true"}
SKIPPED = re.compile(rb"<!--.*?-->|<\?.*?\?>", re.DOTALL)


def breaking(text: Text) -> list[Edit]:
    """Return no edits: files of this type are not broken in order to prove checks."""
    return []


def mending(text: Text, vocabulary: Vocabulary) -> list[Edit]:
    """Return the edits that could mend a wrong file."""
    skipped = [each.span() for each in SKIPPED.finditer(text.content)]
    found = _edits(text, vocabulary)
    return [edit for begin, edit in found if not any(first <= begin < last for first, last in skipped)]


def _edits(text: Text, vocabulary: Vocabulary) -> Iterator[tuple[int, Edit]]:
    content = text.content

    def edit(operator: str, begin: int, end: int, now: str) -> tuple[int, Edit]:
        return begin, text.edit(operator, text.line_of(begin), begin, end, now)

    for match in EXPRESSION.finditer(content):
        a, operator, b = (each.decode() for each in match.groups())
        others = {"+": "-", "-": "+", "*": "/", "/": "*"}
        for now in (f"${{{a}}}", f"${{{b}}}", f"${{{a} {others[operator]} {b}}}", f"${{{b} {operator} {a}}}"):
            yield edit("arithmetic", *match.span(), now)
    for match in VALUE.finditer(content):
        value = match[0].strip()
        if value in SWITCHES:
            yield edit("switch", *match.span(), SWITCHES[value])
        elif b"/" in value or value.isalpha() or b"_" in value:
            for now in nearest(value.decode(errors="replace"), (*vocabulary.topics, *vocabulary.texts)):
                yield edit("name", *match.span(), now)
        for number in NUMBER.finditer(match[0]):
            first = match.start() + number.start()
            was = float(number[0]) if b"." in number[0] or b"e" in number[0].lower() else int(number[0])
            for now in other_numbers(was, vocabulary):
                yield edit("number", first, first + len(number[0]), now)
        if value.startswith(b"${"):
            yield edit("sign", *match.span(), f"${{-({value[2:-1].decode(errors='replace')})}}")
    for match in LEAF.finditer(content):
        yield edit("deleted", *match.span(), "")
