"""Two texts in a list without a comma between them: Python joins them to one."""

from __future__ import annotations

import io
import tokenize
from collections.abc import Iterator

from gz_course.grader.feedback.launch_files import launch_slip
from gz_course.grader.feedback.launch_files.reading import LaunchFile, Place

BRACKETS = {"(": ")", "[": "]", "{": "}"}


@launch_slip
def missing_commas(file: LaunchFile) -> Iterator[Place]:
    """Find two texts on one line that stand side by side in a list."""
    opened: list[str] = []
    before = ""  # the text before, if it ends on this line
    line = 0
    for token in tokenize.tokenize(io.BytesIO(file.content).readline):
        if token.type == tokenize.OP and token.string in BRACKETS:
            opened.append(token.string)
        elif token.type == tokenize.OP and token.string in BRACKETS.values() and opened:
            opened.pop()
        beside = before and token.type == tokenize.STRING and token.start[0] == line
        if beside and opened and opened[-1] == "[":
            yield line, f"a comma is missing between {before} and {token.string}: Python joins the two texts to one"
        before, line = (token.string, token.end[0]) if token.type == tokenize.STRING else ("", 0)
