"""`kind = "table"`: the submission is a YAML table of topics as seen from ROS and from Gazebo.

A row has the topic's names and types on both sides, the direction of its messages and the ROS node that publishes it.
The exercise's world, its bridge and its own node (`given_node.py`) are run, both graphs are recorded as facts, and the
checks compare row by row.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.grader.kinds.exercise_node import diagnosis, run_loop
from gz_course.grader.kinds.given_node import EXERCISE_NODE, exercise_node
from gz_course.grader.kinds.kind import Kind, RunPlan
from gz_course.grader.kinds.programs import node_command
from gz_course.grader.printable import shown
from gz_course.sim.did_you_mean import did_you_mean

if TYPE_CHECKING:
    import yaml

    from gz_course.grader.exercise import Exercise
    from gz_course.grader.submission import Submission

COLUMNS = ("ros_topic", "ros_type", "gz_topic", "gz_type", "direction", "publisher")
MOST_BYTES = 64 * 1024
MOST_ROWS = 200
LONGEST = 200  # [characters] of one value


class TableError(Exception):
    """A file is not such a table: `line`, and the reason in one sentence."""

    def __init__(self, line: int, sentence: str) -> None:
        super().__init__(sentence)
        self.line = line
        self.sentence = sentence


def fault(name: str, content: bytes) -> str | None:
    """Return why a file is not such a table, with its line, or None."""
    try:
        read(name, content)
    except TableError as error:
        return shown(f"{name}, line {error.line}: {error.sentence}")
    return None


def read(name: str, content: bytes) -> list[dict[str, Any]]:
    """Return the rows: a text for each column (empty if it is not filled in) and the `line` in which the row begins.

    Raises TableError for the first thing that does not belong in such a table.
    """
    import yaml

    from gz_course.sim.bridge.ros_gz_bridge.config import ConfigError, compose

    if len(content) > MOST_BYTES:
        raise TableError(1, f"the file has {len(content)} bytes; such a table needs no more than {MOST_BYTES}")
    try:
        root = compose(content, name)
    except ConfigError as error:
        place, _, sentence = error.errors[0].partition(": ")
        raise TableError(int(place.rpartition(":")[2]), sentence) from None
    if root is None or (isinstance(root, yaml.ScalarNode) and not root.value):
        raise TableError(1, "the table is empty; each row begins with '- ros_topic:'")
    if not isinstance(root, yaml.SequenceNode):
        raise TableError(_line(root), f"expected a list of rows; begin each row with '- '{_found(root)}")
    if len(root.value) > MOST_ROWS:
        raise TableError(1, f"{len(root.value)} rows, more than the {MOST_ROWS} a table may have")
    return [_row(node) for node in root.value]


def _found(root: yaml.Node) -> str:
    """Return the end of a sentence on what a file holds that is no list of rows."""
    import yaml

    if isinstance(root, yaml.ScalarNode) and "," in str(root.value):
        return ". Commas separate nothing in this file: each column has a line of its own, 'COLUMN: VALUE'"
    if not isinstance(root, yaml.MappingNode) or not isinstance(root.value[0][0], yaml.ScalarNode):
        return ""
    key = shown(str(root.value[0][0].value), 60)
    if key in COLUMNS:
        return ", as in '- ros_topic: /clock'"
    return f". Here, everything stands below keys, such as {key!r}; a row has no name of its own"


def _row(node: yaml.Node) -> dict[str, Any]:
    import yaml

    if not isinstance(node, yaml.MappingNode):
        raise TableError(_line(node), f"expected a row (lines of 'column: value'): {', '.join(COLUMNS)}")
    row: dict[str, Any] = {"line": _line(node)} | dict.fromkeys(COLUMNS, "")
    first: dict[str, int] = {}
    columns = [key.value for key, _ in node.value if isinstance(key, yaml.ScalarNode)]
    for place, (key, value) in enumerate(node.value):
        column = key.value if isinstance(key, yaml.ScalarNode) else ""
        if column not in COLUMNS:
            hint = did_you_mean(str(column), COLUMNS) or "; write your own notes after a #, not in a column"
            raise TableError(_line(key), f"there is no column {shown(str(column), 60)!r}{hint}")
        if column in first:
            again = sum(other in first for other in columns[place:])
            dash = f": a dash is missing here, '- {column}:' begins the next row" if again > 1 else ""
            raise TableError(_line(key), f"{column} appears twice in one row (first in line {first[column]}){dash}")
        first[column] = _line(key)
        row[column] = _text(column, value)
    return row


def _text(column: str, node: yaml.Node) -> str:
    import yaml

    if not isinstance(node, yaml.ScalarNode):
        raise TableError(_line(node), f"{column} must be one value, not a list or a table of its own")
    text = "" if node.tag.endswith(":null") else node.value.strip()
    if len(text) > LONGEST:
        raise TableError(_line(node), f"{column} has {len(text)} characters; no name is longer than {LONGEST}")
    return shown(text)


def _line(node: yaml.Node) -> int:
    return int(node.start_mark.line) + 1


def plan(exercise: Exercise, submission: Submission) -> RunPlan:
    """Run the exercise's own node and bridge; record the rows."""
    from gz_course.grader.run.exercise_bridge import exercise_bridge

    rows = read(submission.main, submission.files[submission.main])
    entries = exercise_bridge(exercise)
    return RunPlan(EXERCISE_NODE, exercise_node(exercise), entries, lambda: {"table": rows}, exercise.bridge_parameters)


KIND = Kind((".yaml", ".yml"), fault, plan, node_command, run_loop, diagnosis)
