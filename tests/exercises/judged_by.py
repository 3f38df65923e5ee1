"""What the checks of an exercise judge by: the numbers and names of its manifest, its Python, and the kinds it uses.

Collected from the text of the files, so that nothing is left out because nobody has thought of it. A number of Python
counts if it is a constant at the top of a file whose function is a check, or one that such a file imports.
"""

from __future__ import annotations

import ast
import inspect
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from gz_course.grader.score.check import check_kinds

Judged = tuple[str, float | str]  # where it stands, and what it is

# Keys of a manifest whose texts are for people, or for the report; and those that name something inside the grader.
WORDS = {"id", "title", "hints", "hint", "otherwise", "consequence_of", "unit", "name", "kind", "function", "check"}
INSIDE = {"statistic", "axis", "log", "explain", "same", "points"}
DIRECTIONS = {"GZ_TO_ROS": "from Gazebo", "ROS_TO_GZ": "to Gazebo"}


def judged_by(grading: Path) -> Iterator[Judged]:
    """Yield everything that the exercise with this folder `grading` judges by."""
    manifest = tomllib.loads((grading / "exercise.toml").read_text())
    run = manifest["run"]
    yield "run.duration", float(run["duration"])
    if "tick" in run:
        yield "run.tick", float(run["tick"])
    if "real_time_factor" in run:
        yield "run.real_time_factor", float(run["real_time_factor"])
    for topic, kind in run.get("observe", {}).items():
        yield from ((f"run.observe.{topic}", topic), (f"run.observe.{topic}", kind))
    files: dict[Path, None] = {}
    for check in manifest["check"]:
        yield from _of(check, check["id"])
        if "function" in check:
            files[grading / check["function"].partition(":")[0]] = None
        kind = check_kinds()[check["kind"]]
        source = Path(inspect.getfile(kind))
        if check["kind"] != "python":
            yield from _defaults(source, check)
            files[source] = None
    for path in files:
        yield from _constants(path)


def _of(table: dict[str, Any], where: str) -> Iterator[Judged]:
    for key, value in table.items():
        if key in WORDS | INSIDE:
            continue
        for each in value if isinstance(value, list) else [value]:
            if isinstance(each, dict):
                yield from _of(each, f"{where}.{key}")
            elif isinstance(each, bool):  # that of a function says which half of a task it is about
                yield from [] if "function" in table else [(f"{where}.{key}", str(each).lower())]
            elif isinstance(each, int | float):
                yield f"{where}.{key}", float(each)
            elif each.startswith("topics/"):
                topic, *field = each.split("/")[1:]
                yield f"{where}.{key}", f"/{topic}"
                if field != ["data"]:  # the only field of its type
                    yield f"{where}.{key}", ".".join(field)
            elif not each.startswith("truth/"):
                yield f"{where}.{key}", DIRECTIONS.get(each, each)


def _defaults(path: Path, check: dict[str, Any]) -> Iterator[Judged]:
    """Yield the numbers that a kind of check takes for parameters that the manifest does not give."""
    for node in ast.walk(ast.parse(path.read_text())):
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute) or len(node.args) != 2:
            continue
        if node.func.attr not in ("number", "integer") or not isinstance(node.args[0], ast.Constant):
            continue
        key, value = node.args[0].value, _number(node.args[1])
        if key not in check and value is not None:
            yield f"{check['kind']}.{key}", value


def _constants(path: Path, wanted: set[str] | None = None) -> Iterator[Judged]:
    """Yield the constants at the top of a file, and those that it imports from files beside it."""
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.Assign):
            for name, value in _assigned(node.targets[0], node.value):
                if name.isupper() and (wanted is None or name in wanted):
                    yield f"{path.stem}.{name}", value
        elif wanted is None and isinstance(node, ast.ImportFrom) and node.level == 1 and node.module:
            names = {alias.name for alias in node.names if alias.name.isupper()}
            yield from _constants(path.parent / f"{node.module}.py", names) if names else []


def _assigned(target: ast.expr, value: ast.expr) -> Iterator[tuple[str, float]]:
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        for left, right in zip(target.elts, value.elts, strict=False):
            yield from _assigned(left, right)
    elif isinstance(target, ast.Name):
        parts = value.elts if isinstance(value, ast.Tuple) else [value]
        yield from ((target.id, number) for part in parts if (number := _number(part)) is not None)


def _number(node: ast.expr) -> float | None:
    try:
        value = ast.literal_eval(node)
    except ValueError:
        return None
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None
