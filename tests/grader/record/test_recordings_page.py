"""The page on recordings lists exactly what the classes and the recorder have, and its example runs."""

import ast
import dataclasses
import inspect
import re
from pathlib import Path

from gz_course.grader.record.reading import Line, Poses, Recording, Signal
from gz_course.grader.score.check import Finding

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs/recordings.md").read_text()


def section(heading):
    (found,) = [part for part in re.split(r"\n(?=## )", PAGE) if part.startswith(f"## {heading}\n")]
    return found


def first_cells(heading):
    """The names in backticks in the first column of the tables of a section."""
    rows = [line.split(" | ")[0] for line in section(heading).splitlines() if line.startswith("| `")]
    return [name for row in rows for name in re.findall(r"`([^`]+)`", row)]


def test_the_methods_and_attributes_of_a_recording():
    named = {}
    for name, member in vars(Recording).items():
        if not name.startswith("_"):
            shown = ""
            if inspect.isfunction(member):
                parts = [
                    each.name if each.default is each.empty else f'{each.name}="{each.default}"'
                    for each in list(inspect.signature(member).parameters.values())[1:]
                ]
                shown = f"({', '.join(parts)})"
            named[name] = f"{name}{shown}"
    assert first_cells("`Recording`") == sorted([*named.values(), "path"])


def test_the_fields_of_what_it_returns():
    fields = [f"{of.__name__}.{each.name}" for of in (Signal, Line, Poses) for each in dataclasses.fields(of)]
    assert first_cells("`Signal`, `Line`, `Poses`") == fields
    assert set(first_cells("`Finding`")) == {each.name for each in dataclasses.fields(Finding)}


def test_the_truth_is_listed_name_by_name():
    """As the scene records it: its dictionary of names is read from its source."""
    tree = ast.parse((ROOT / "grader/record/scene.py").read_text())
    (truth,) = [
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "truth" and isinstance(node.value, ast.Dict)
    ]
    recorded = {f"truth/MODEL/{ast.literal_eval(key)}" for key in truth.keys}
    listed = {name for name in first_cells("Signals") if name.startswith("truth/")}
    assert listed == recorded


def test_what_has_a_unit_says_it():
    for heading in ("`Recording`", "Signals"):
        for line in section(heading).splitlines():
            if re.search(r"\b(times?|position|speed|rate|way|cloud|end) ", line) and line.startswith("| `"):
                assert re.search(r"\[[^\]]+\]|1\.0 ", line), line


def test_the_example_runs(record):
    text = re.search(r"```python\n(.*?)```", PAGE, re.DOTALL)[1]
    names = {}
    exec(compile(text, "docs/recordings.md", "exec"), names)
    slow = record({"truth/robot/linear_x": [(0, 0.1), (1, -0.3)]})
    assert names["stays_slow"](slow, {"most": 0.4}).value == 0.3
    assert not names["stays_slow"](slow, {"most": 0.2}).passed
    assert names["stays_slow"](record(), {"most": 0.2}).nothing


def test_parameters_and_private_data_of_a_trial(record):
    made = record(trial_parameters='{"poses": {}, "parameters": {"speed": 0.4}}', trial_private='{"door": 3}')
    assert (made.parameters, made.private) == ({"speed": 0.4}, {"door": 3})
    assert (record().parameters, record().private) == ({}, {})
