"""The filter for git: what a run leaves in a notebook is no change, and what a reader wrote is one."""

import json
import subprocess
import sys

import nbformat
import pytest

from gz_course.grader.tools import notebook_outputs
from gz_course.grader.tools.notebook_outputs import after_save, as_committed


@pytest.fixture
def committed(root):
    return sorted((root / "chapters").glob("*/*.ipynb"))[0].read_text()


def test_the_chapters_are_as_it_writes_them(root):
    for path in (root / "chapters").glob("*/*.ipynb"):
        assert as_committed(path.read_text()) == path.read_text(), path


def test_a_run_leaves_no_trace_and_a_word_does(committed):
    notebook = nbformat.reads(committed, as_version=4)
    notebook.metadata["language_info"]["version"] = "3.12.1"
    for number, cell in enumerate(notebook.cells):
        cell.metadata["scrolled"] = True
        if cell.cell_type == "code":
            cell.execution_count = number
            cell.outputs = [nbformat.v4.new_output("stream", text="grüße\n")]
    assert as_committed(nbformat.writes(notebook)) == committed
    notebook.cells[0].source += " mine"
    assert as_committed(nbformat.writes(notebook)) != committed


@pytest.mark.parametrize("text", ["", "no notebook", "[]", json.dumps({"cells": [{}]}), json.dumps({"cells": 1})])
def test_what_is_no_notebook_is_passed_on(text):
    assert as_committed(text) == text


def test_git_runs_it_with_nothing_but_python(committed):
    done = subprocess.run(
        [sys.executable, "-I", "-S", notebook_outputs.__file__],
        input=committed.encode(), capture_output=True, check=True,
    )  # fmt: skip
    assert done.stdout.decode() == committed


def test_a_chapter_that_was_run_and_saved_is_no_change_and_an_edited_one_is(committed, tmp_path):
    def git(*words):
        return subprocess.run(["git", *words], cwd=tmp_path, check=True, capture_output=True, text=True).stdout

    path = tmp_path / "a b.ipynb"
    path.write_text(committed)
    (tmp_path / ".gitattributes").write_text("*.ipynb filter=notebook-outputs\n")
    git("init", "-q")
    git("config", "filter.notebook-outputs.clean", f"'{sys.executable}' -I -S '{notebook_outputs.__file__}'")
    git("add", ".")
    git("-c", "user.name=x", "-c", "user.email=x@y", "commit", "-qm", "x")
    notebook = nbformat.from_dict(json.loads(committed))
    notebook.metadata["language_info"]["version"] = "3.12.1"
    nbformat.write(notebook, path)
    after_save(os_path=str(path), model={}, contents_manager=None)
    assert git("status", "--short") == ""
    notebook.cells[0].source += " mine"
    nbformat.write(notebook, path)
    after_save(os_path=str(path), model={}, contents_manager=None)
    assert git("status", "--short") == ' M "a b.ipynb"\n'
