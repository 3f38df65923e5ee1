"""Every cell to write is answered right: untouched, with each wrong answer that is declared, and solved.

The solved cells stand in `solutions/NN_name/cells/`, one file a step; `wrong.toml` beside them holds wrong answers.
"""

import asyncio
import re
import tomllib
from pathlib import Path

import nbformat
import pytest

from gz_course.grader.lessons.cell import UNTOUCHED, untouched
from gz_course.grader.lessons.lesson import load_lesson, number_of_steps
from gz_course.grader.lessons.step import COMMANDS, PYTHON
from gz_course.tests.chapters.notebooks import NOTEBOOKS, ROOT, client_of, code_cells, copy_of_course, printed, read

FEWEST_STEPS = 4
FEWEST_WRONG = 3
SUFFIX = {PYTHON: ".py", COMMANDS: ".sh"}
MARK = "%%step "
PREDICT = re.compile(r'^room\.predict\("(\w+)"\)$', re.MULTILINE)

each_notebook = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def lesson_of(path):
    return load_lesson(ROOT / "exercises" / path.stem)


def step_cells(path):
    """The text of each cell to write, by the name of its step."""
    bodies = (cell.source.partition("\n") for cell in code_cells(path) if cell.source.startswith(MARK))
    return {first.removeprefix(MARK).strip(): rest for first, _, rest in bodies}


def solved(path, step):
    suffix = SUFFIX.get(step.form) or Path(step.form).suffix
    return (ROOT / "solutions" / path.stem / "cells" / f"{step.name}{suffix}").read_text()


def wrong(path):
    """Wrong answers: step -> name -> its cell, and words of the sentence it is given."""
    return tomllib.loads((ROOT / "solutions" / path.stem / "cells/wrong.toml").read_text())


@each_notebook
def test_the_notebook_has_a_cell_for_each_step_and_they_are_untouched(path):
    cells, steps = step_cells(path), lesson_of(path).steps
    assert list(cells) == list(steps)
    assert len(steps) >= FEWEST_STEPS
    assert [name for name, body in cells.items() if not untouched(body, steps[name].form)] == []


@each_notebook
def test_the_list_counts_the_steps_that_the_lesson_has(path):
    assert number_of_steps(ROOT / "exercises" / path.stem / "grading") == len(lesson_of(path).steps)


@each_notebook
def test_each_step_has_a_solution_and_wrong_answers(path):
    steps, answers = lesson_of(path).steps, wrong(path)
    assert answers.keys() == steps.keys()
    for name, step in steps.items():
        assert not untouched(solved(path, step), step.form)
        assert len(answers[name]) >= FEWEST_WRONG
        assert step.task, f"step {name} says nowhere what it asks"


@each_notebook
def test_each_prediction_is_asked_by_the_cell_before_its_experiment(path):
    asked = [name for cell in code_cells(path) for name in PREDICT.findall(cell.source)]
    assert asked == list(lesson_of(path).predictions)


@each_notebook
def test_each_question_and_each_cell_serves_an_objective_of_the_chapter(path):
    lesson = lesson_of(path)
    listed = re.search(r"\*\*Objectives\.\*\*.*?\n((?:\n|- .*\n|  .*\n)+)", read(path).cells[0].source)
    numbers = set(range(1, listed[1].count("\n- ") + listed[1].startswith("- ") + 1))
    used = {each.objective for each in (*lesson.steps.values(), *lesson.predictions.values(), *lesson.review)}
    assert used == lesson.graded.keys() == numbers


def attempts(path):
    """The notebook with each cell to write three ways: untouched, wrong, solved; and what each must say, by cell id."""
    notebook, lesson, answers, expected = read(path), lesson_of(path), wrong(path), {}
    cells = []
    for cell in notebook.cells:
        cells.append(cell)
        if not cell.source.startswith(MARK):
            continue
        step = lesson.steps[cell.source.partition("\n")[0].removeprefix(MARK).strip()]
        expected[cell.id] = f"\u2718 Not yet. {UNTOUCHED}"
        variants = {name: (each["cell"], each["says"]) for name, each in answers[step.name].items()}
        variants["solved"] = (solved(path, step), "\u2714 Done. ")
        for name, (body, says) in variants.items():
            source = f"{MARK}{step.name}\n{body.strip()}"
            cells.append(nbformat.v4.new_code_cell(source, id=f"{cell.id}-{name}"))
            expected[cells[-1].id] = says
    notebook.cells = cells
    return notebook, expected


@pytest.mark.proof
@pytest.mark.timeout(2400)
@each_notebook
def test_every_cell_is_answered_right_untouched_wrong_and_solved(path, tmp_path):
    folder = copy_of_course(path, tmp_path)
    notebook, expected = attempts(path)
    client = client_of(notebook, folder)
    asyncio.run(run(client))
    said = {cell.id: printed(cell) for cell in client.nb.cells if cell.id in expected}
    false = {name: text for name, text in said.items() if expected[name] not in text or _marks(text, expected[name])}
    assert false == {}


def _marks(text, expected):
    """Tell whether a wrong answer was called done."""
    return "\u2714" in text and "\u2714" not in expected


async def run(client):
    async with client.async_setup_kernel():
        for index, cell in enumerate(client.nb.cells):
            await client.async_execute_cell(cell, index)
