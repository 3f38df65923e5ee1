"""The remappings that a launch file gives its nodes; whether they do anything, only the topics of a run show."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.lint.launch_files.reading import LaunchFile, argument, text


def remappings(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line`, the `namespace` of the node (empty for the root), and the names `from` and `to`, as written."""
    for call in file.calls("Node", "LifecycleNode"):
        given = file.value(argument(call, "remappings"))
        space = text(file.value(argument(call, "namespace"))).strip("/")
        for pair in given.elts if isinstance(given, ast.List | ast.Tuple) else ():
            if isinstance(pair, ast.Tuple | ast.List) and len(pair.elts) == 2:
                old, new = (text(file.value(each)) for each in pair.elts)
                if old and new:
                    yield {"line": pair.lineno, "namespace": space, "from": old, "to": new}
