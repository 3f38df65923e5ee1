"""The remappings that a launch file gives its nodes; whether they do anything, only the topics of a run show."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from gz_course.grader.feedback.launch_files import launch_fact
from gz_course.grader.feedback.launch_files.reading import LaunchFile, argument, text


@launch_fact("remappings")
def remappings(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line`, the `namespace` of the node (empty for the root), and the names `from` and `to`, as written.

    Rules among the words of a command, `-r FROM:=TO`, come after those in `remappings`.
    """
    for call in file.calls("Node", "LifecycleNode"):
        given = file.value(argument(call, "remappings"))
        space = text(file.value(argument(call, "namespace"))).strip("/")
        for pair in given.elts if isinstance(given, ast.List | ast.Tuple) else ():
            if isinstance(pair, ast.Tuple | ast.List) and len(pair.elts) == 2:
                old, new = (text(file.value(each)) for each in pair.elts)
                if old and new:
                    yield {"line": pair.lineno, "namespace": space, "from": old, "to": new}
    for call in file.calls("Node", "LifecycleNode", "ExecuteProcess"):
        words = file.value(argument(call, "arguments") or argument(call, "cmd", 0))
        said = [(each.lineno, text(each)) for each in words.elts] if isinstance(words, ast.List | ast.Tuple) else []
        rules = {line_and_word for option, line_and_word in pairwise(said) if option[1] in ("-r", "--remap")}
        spaces = [word.partition(":=")[2] for _, word in rules if word.startswith("__ns:=")]
        space = (spaces or [text(file.value(argument(call, "namespace")))])[0].strip("/")
        for line, word in sorted(rules):
            old, _, new = word.partition(":=")
            if old and new and not old.startswith("__"):
                yield {"line": line, "namespace": space, "from": old, "to": new}
