"""How many actions the loops of a launch file make at most, where a number or a list in the file decides that."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.facts.syntax import functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.launch_files import launch_fact
from gz_course.grader.feedback.launch_files.reading import PROCESSES, LaunchFile, argument, text

ROUND = ("enumerate", "list", "tuple", "sorted", "reversed", "items", "keys", "values")


@launch_fact("fixed_counts")
def fixed_counts(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line`, `count` and `said` (what ends there) of each loop that makes so many actions at most.

    Actions of `create` that the file holds one by one are counted, too.
    """
    makers = {f.name for f in functions(file.tree) if any(_starts(each) for each in walk(f))}
    loops = [node for node in file.nodes if isinstance(node, ast.For | ast.ListComp | ast.GeneratorExp)]
    inside = set[int]()
    for loop in loops:
        parts = loop.body if isinstance(loop, ast.For) else [loop.elt]
        calls = [each for part in parts for each in nodes_of(part, ast.Call)]
        inside |= {id(each) for each in calls}
        if not any(_starts(each) or last_name(each.func) in makers for each in calls):
            continue
        for over in [loop.iter] if isinstance(loop, ast.For) else [each.iter for each in loop.generators]:
            if found := _length(file, over):
                count, place = found
                yield {"line": place.lineno, "count": count, "said": f"{_shown(over)} ends at {count}"}
    for call in file.calls("min"):
        numbers = [each.value for each in call.args if isinstance(each, ast.Constant) and isinstance(each.value, int)]
        if len(call.args) == 2 and numbers and "robots" in unparse(call):
            said = f"{unparse(call)[:60]} is never more than {numbers[0]}"
            yield {"line": call.lineno, "count": numbers[0], "said": said}
    made = [call for call in file.calls("Node") if text(argument(call, "executable", 0)) == "create"]
    in_functions = {id(each) for f in functions(file.tree) if f.name in makers for each in walk(f)}
    written = [call for call in made if id(call) not in inside and (id(call) not in in_functions or len(made) > 1)]
    if len(written) > 1:
        said = f"the file holds {len(written)} actions of create, one by one"
        yield {"line": written[-1].lineno, "count": len(written), "said": said}


def _starts(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and last_name(node.func) in PROCESSES


def _shown(over: ast.expr) -> str:
    said = unparse(over)
    return said if len(said) <= 40 else "the list"


def _length(file: LaunchFile, over: ast.expr) -> tuple[int, ast.expr] | None:
    """Return how many items there are at most, and where that is written; None if the file does not say so."""
    over = file.value(over) or over
    if isinstance(over, ast.List | ast.Tuple | ast.Set) and not any(isinstance(e, ast.Starred) for e in over.elts):
        return len(over.elts), over
    if isinstance(over, ast.Dict) and None not in over.keys:
        return len(over.keys), over
    if isinstance(over, ast.Subscript) and isinstance(over.slice, ast.Slice):
        return _length(file, over.value)
    if not isinstance(over, ast.Call):
        return None
    name = last_name(over.func)
    if name == "range":
        ends = [file.value(each) for each in over.args]
        values = [each.value for each in ends if isinstance(each, ast.Constant) and isinstance(each.value, int)]
        return (len(range(*values)), over) if 0 < len(values) == len(over.args) <= 2 else None
    if name == "zip":
        lengths = [found for each in over.args if (found := _length(file, each))]
        return min(lengths, key=lambda each: each[0], default=None)
    if name in ROUND and (over.args or isinstance(over.func, ast.Attribute)):
        return _length(file, over.args[0] if over.args else over.func.value)  # type: ignore[attr-defined]
    return None
