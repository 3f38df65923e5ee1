"""Every chapter's notebook runs from its first cell to its last in a real kernel, and cleans up after itself."""

import ast
import asyncio
import ctypes
import importlib.util
import re
import shutil
from pathlib import Path

import nbformat
import psutil
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "chapters").glob("*/*.ipynb"))
CELL_DEADLINE = 120  # [s]
PR_SET_CHILD_SUBREAPER = 36

each_notebook = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def read(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    return notebook


def code_cells(path):
    return [cell for cell in read(path).cells if cell.cell_type == "code"]


def python_of(cell):
    """The Python of a cell; lines for the shell become `pass`."""
    return re.sub(r"^(\s*)[!%].*$", r"\1pass", cell.source, flags=re.MULTILINE)


def test_there_are_chapters():
    assert NOTEBOOKS


@pytest.mark.parametrize("folder", sorted(p for p in (ROOT / "chapters").iterdir() if p.is_dir()), ids=lambda p: p.name)
def test_a_chapter_has_a_notebook_and_an_exercise_of_its_name(folder):
    assert (folder / f"{folder.name}.ipynb").is_file()
    assert (ROOT / "exercises" / folder.name / "exercise.toml").is_file()


@each_notebook
def test_begins_with_objectives_and_ends_with_its_exercise(path):
    first, *_, last = read(path).cells
    assert first.cell_type == last.cell_type == "markdown"
    assert "**Objectives.**" in first.source and "\n- " in first.source
    assert f"course grade {path.stem}" in last.source


@each_notebook
def test_is_committed_without_traces_of_a_run(path):
    notebook = read(path)
    assert notebook.metadata == {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    for cell in notebook.cells:
        assert cell.metadata == {}
        if cell.cell_type == "code":
            assert (cell.outputs, cell.execution_count) == ([], None), f"cell {cell.id} has been run"
    assert str(ROOT) not in path.read_text() and str(Path.home()) not in path.read_text()


@each_notebook
def test_imports_only_what_is_there(path):
    for cell in code_cells(path):
        for node in ast.walk(ast.parse(python_of(cell))):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [node.module]
            for name in names:
                assert importlib.util.find_spec(name), f"cell {cell.id} imports {name}, which is not installed"


@pytest.fixture
def descendants():
    """Function giving the processes that came from this one during the test, orphans included."""
    ours = psutil.Process()
    before = set(ours.children(recursive=True))
    libc = ctypes.CDLL(None)
    assert libc.prctl(PR_SET_CHILD_SUBREAPER, 1) == 0

    def living():
        found = set(ours.children(recursive=True)) - before
        return [p for p in found if p.is_running() and p.status() != psutil.STATUS_ZOMBIE]

    yield living
    for process in living():
        process.kill()
    libc.prctl(PR_SET_CHILD_SUBREAPER, 0)


def commands(processes):
    return [" ".join(process.cmdline()) for process in processes]


@each_notebook
def test_runs_from_first_to_last_cell_and_leaves_nothing_running(path, tmp_path, descendants):
    folder = tmp_path / path.parent.name
    shutil.copytree(path.parent, folder, ignore=shutil.ignore_patterns("runs", "recorded_run", ".ipynb_checkpoints"))
    client = NotebookClient(
        read(folder / path.name), timeout=CELL_DEADLINE, resources={"metadata": {"path": str(folder)}}
    )

    async def run():
        async with client.async_setup_kernel():
            kernel = set(descendants())
            assert kernel, "the kernel is a process of its own"
            for index, cell in enumerate(client.nb.cells):
                await client.async_execute_cell(cell, index)
            # The cells themselves must have ended what they started, not the end of the kernel.
            assert commands(set(descendants()) - kernel) == []

    asyncio.run(run())
    assert commands(descendants()) == []
    printed = [cell for cell in client.nb.cells if cell.cell_type == "code" and cell.outputs]
    report = "".join(output.get("text", "") for cell in printed for output in cell.outputs)
    assert "score: " in re.sub(r"\x1b\[[0-9;]*m", "", report), "the notebook has graded its exercise"
