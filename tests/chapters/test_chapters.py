"""Every chapter's notebook keeps to the pattern, runs in a real kernel, bears a second run of each cell, and cleans up.

`chapters/README.md` says the rules in words.
"""

import ast
import asyncio
import base64
import ctypes
import importlib.util
import itertools
import re
import struct
import subprocess
from pathlib import Path

import nbformat
import psutil
import pytest

from gz_course.tests.chapters.notebooks import NOTEBOOKS, ROOT, client_of, code_cells, copy_of_course, printed, read

WIDEST = 1280  # [pixels] of a picture
LONGEST_LINE = 88  # [characters] of code
FEWEST_PREDICTIONS = 4
FEWEST_PICTURES = 3
ASK = "room.predict("
PREDICTION, DESCRIPTION, CHECK = "> **Predict.**", "**In the picture:**", "## Check my work"
# What of the course's own code a student may meet: everything else stands in the notebook.
OF_THE_COURSE = {"gz_course.grader.tools.playground", "gz_course.grader.record.reading"}
PR_SET_CHILD_SUBREAPER = 36

each_notebook = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def python_of(cell):
    """The Python of a cell; lines for the shell and for the notebook become `pass`, files are Python or nothing."""
    if cell.source.startswith("%%step "):
        return ""  # its reader writes it
    if cell.source.startswith("%%writefile"):
        first, _, rest = cell.source.partition("\n")
        return rest if first.endswith(".py") else ""
    return re.sub(r"^(\s*)(\w+ = )?[!%](.*\\\n)*.*$", r"\1pass", cell.source, flags=re.MULTILINE)


def shell_lines(cell):
    """The commands a cell gives to the shell."""
    return re.findall(r"^\s*(?:\w+ = )?!(.*)$", cell.source, flags=re.MULTILINE)


def shell_words(path):
    """The words of each command that a notebook gives to the shell."""
    return [line.split() for cell in code_cells(path) for line in shell_lines(cell)]


def pairs(path):
    """Each cell with the one after it."""
    cells = read(path).cells
    return list(itertools.pairwise(cells))


def test_there_are_chapters():
    assert NOTEBOOKS


@pytest.mark.parametrize("folder", sorted(p for p in (ROOT / "chapters").iterdir() if p.is_dir()), ids=lambda p: p.name)
def test_a_chapter_has_a_notebook_and_an_exercise_of_its_name(folder):
    assert (folder / f"{folder.name}.ipynb").is_file()
    assert (ROOT / "exercises" / folder.name / "grading/exercise.toml").is_file()


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
def test_no_line_of_code_is_too_long_to_be_seen(path):
    lines = [(cell.id, line) for cell in code_cells(path) for line in cell.source.splitlines()]
    assert [each for each in lines if len(each[1]) > LONGEST_LINE] == []


@each_notebook
def test_imports_only_what_is_there(path):
    own = {words[-1] for words in shell_words(path) if "pkg create" in " ".join(words)}
    for cell in code_cells(path):
        for node in ast.walk(ast.parse(python_of(cell))):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [node.module]
            for name in names:
                if name.partition(".")[0] in own:
                    continue  # the chapter builds it
                assert importlib.util.find_spec(name), f"cell {cell.id} imports {name}, which is not installed"


@each_notebook
def test_no_hidden_code(path):
    """Nodes, plots and helpers stand in the notebook: only the playground and recordings come from the course."""
    for cell in code_cells(path):
        for node in ast.walk(ast.parse(python_of(cell))):
            if isinstance(node, ast.ImportFrom) and node.module and node.module.partition(".")[0] == "grader":
                assert node.module in OF_THE_COURSE, f"cell {cell.id} imports {node.module}"


@each_notebook
def test_predictions_come_right_before_their_experiments(path):
    predictions = [(cell, after) for cell, after in pairs(path) if PREDICTION in cell.source]
    assert len(predictions) >= FEWEST_PREDICTIONS
    cells = read(path).cells
    for cell, after in predictions:
        assert after.cell_type == "code", f"cell {cell.id} predicts, but no experiment follows"
        if after.source.startswith(ASK):
            number = [each.id for each in cells].index(after.id)
            assert cells[number + 1].cell_type == "code", f"cell {after.id} asks, but no experiment follows"
        assert cell.source.rpartition("\n\n")[2].startswith(PREDICTION), f"cell {cell.id} goes on after its prediction"


@each_notebook
def test_what_topics_there_are_is_asked_before_it_is_shown(path):
    asked = [(cell, after) for cell, after in pairs(path) if not after.source.startswith(ASK)]
    for cell, after in asked:
        if cell.source.startswith(ASK):
            continue  # whose prediction stands before it
        if after.cell_type == "code" and any(re.match(r"(ros2|gz) topic (list|-l)", c) for c in shell_lines(after)):
            assert PREDICTION in cell.source, f"cell {after.id} shows topics without a prediction"


@each_notebook
def test_every_picture_is_described_in_words(path):
    shown = ("plt.show()", "room.replay(", "room.show(", "room.watch(")
    code = [(cell, after) for cell, after in pairs(path) if cell.cell_type == "code"]
    pictures = [(cell, after) for cell, after in code if any(call in cell.source for call in shown)]
    assert len(pictures) >= FEWEST_PICTURES
    for cell, after in pictures:
        assert after.source.startswith(DESCRIPTION), f"cell {cell.id} shows a picture that is not described"


@each_notebook
def test_work_is_checked_by_the_grader_itself(path):
    checks = [(cell, after) for cell, after in pairs(path) if CHECK in cell.source]
    assert len(checks) == 1
    cells = read(path).cells
    after = next(cell for cell in cells[cells.index(checks[0][1]) :] if not cell.source.startswith(ASK))
    assert shell_lines(after)[0].startswith(f"course grade {path.stem}")


@each_notebook
def test_the_file_to_edit_is_named_and_shown(path):
    import tomllib

    manifest = tomllib.loads((ROOT / "exercises" / path.stem / "grading/exercise.toml").read_text())
    prose = "".join(cell.source for cell in read(path).cells if cell.cell_type == "markdown")
    assert f"exercises/{path.stem}/{manifest['file']}" in prose
    assert any(manifest["file"] in cell.source for cell in code_cells(path)), "no cell shows the file"


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


def files_in(folder):
    return {str(each.relative_to(folder)) for each in folder.rglob("*") if each.is_file()}


def not_ignored(files):
    """The files of the clone that git does not ignore; none if this is no clone."""
    if not files or not (ROOT / ".git").exists():
        return []
    command = ["git", "check-ignore", "--no-index", "--stdin"]
    found = subprocess.run(command, cwd=ROOT, input="\n".join(files), capture_output=True, text=True, check=False)
    return sorted(set(files) - set(found.stdout.splitlines()))


def test_files_that_cells_of_a_chapter_make_are_ignored_by_git():
    made = ["chapters/06_spawn/level.sdf", "chapters/06_spawn/wagon.urdf.xacro", "chapters/06_spawn/wagon.yaml"]
    assert not_ignored(made) == []


def execute(path, tmp_path, descendants, times):
    """Run a notebook in a copy of the course, each code cell so many `times`; return what the cells put out.

    The cells themselves must have ended what they started, not the end of the kernel.
    """
    folder = copy_of_course(path, tmp_path)
    before = files_in(folder)
    notebook = read(folder / path.name)
    notebook.cells = [
        nbformat.from_dict(cell | {"id": f"{cell.id}-{number}"})
        for cell in notebook.cells
        for number in range(times if cell.cell_type == "code" else 1)
    ]
    client = client_of(notebook, folder)

    async def run():
        async with client.async_setup_kernel():
            kernel = set(descendants())
            assert kernel, "the kernel is a process of its own"
            for index, cell in enumerate(client.nb.cells):
                await client.async_execute_cell(cell, index)
            assert commands(set(descendants()) - kernel) == []

    asyncio.run(run())
    assert commands(descendants()) == []
    made = [f"chapters/{path.stem}/{each}" for each in files_in(folder) - before]
    assert not_ignored(made) == [], "git would see these files beside the notebook"
    for cell in client.nb.cells:
        if cell.cell_type == "code":
            said = printed(cell)
            for trouble in ("Traceback (most recent call last)", "internal error", "command not found", "No such file"):
                assert trouble not in said, f"cell {cell.id} prints:\n{said}"
            pictures = [output for output in cell.outputs if "image/png" in output.get("data", {})]
            assert bool(pictures) == ("plt.show()" in cell.source), f"cell {cell.id} shows {len(pictures)} pictures"
            widths = [struct.unpack(">I", base64.b64decode(each["data"]["image/png"])[16:20])[0] for each in pictures]
            assert max(widths, default=0) <= WIDEST, f"cell {cell.id} shows a picture {widths} pixels wide"
            replayed = [
                output for output in cell.outputs if "<iframe sandbox" in output.get("data", {}).get("text/html", "")
            ]
            assert bool(replayed) == ("room.replay(" in cell.source), f"cell {cell.id} replays {len(replayed)} runs"
    report = "".join(printed(cell) for cell in client.nb.cells if cell.cell_type == "code")
    assert report.count("score: ") == times, "the notebook has graded its exercise"


@pytest.mark.proof
@pytest.mark.timeout(2400)
@each_notebook
def test_runs_from_first_to_last_cell_and_leaves_nothing_running(path, tmp_path, descendants):
    execute(path, tmp_path, descendants, times=1)


@pytest.mark.proof
@pytest.mark.timeout(2400)
@each_notebook
def test_every_cell_may_be_run_again_at_once(path, tmp_path, descendants):
    execute(path, tmp_path, descendants, times=2)
