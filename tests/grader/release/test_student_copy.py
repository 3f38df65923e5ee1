"""`course release`: the students' copy works on its own and holds nothing that gives a solution away."""

import json
import re
import shutil
import tomllib
from pathlib import Path

import pytest

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise import exercise_names, find_exercise
from gz_course.grader.release.student_copy import release

NAME, FILE = "03_teleop", "teleop_node.py"
ORDINARY, OWN = 20, 40  # [characters] of a line: too short to give anything away; long enough to be nobody else's


@pytest.fixture(scope="module")
def student(tmp_path_factory, root):
    """The students' copy of this very course."""
    folder = tmp_path_factory.mktemp("released") / "student"
    release(root, folder)
    return folder


@pytest.fixture
def small(tmp_path, root):
    """A course with one exercise and its chapter, to be spoilt; the programs are those of this checkout."""
    for half in ("exercises", "solutions", "chapters"):
        shutil.copytree(root / half / NAME, tmp_path / "small" / half / NAME)
    return tmp_path / "small"


def texts(folder):
    return {
        path.relative_to(folder): path.read_bytes().decode(errors="replace").replace('\\"', '"')
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def lines_of(text):
    return {line.strip() for line in text.splitlines()}


def test_no_file_and_no_line_of_a_solution_is_in_it(student, root):
    released = texts(student)
    public = set().union(
        *(lines_of(text) for half in ("exercises", "chapters") for text in texts(root / half).values())
    )
    chapters = "".join(text for path, text in texts(root / "chapters").items() if path.suffix == ".ipynb")
    solved = {path: text for path, text in texts(root / "solutions").items() if path.name != "wrong.toml"}
    private = set().union(*map(lines_of, solved.values())) - public
    imports = ("import ", "from ")  # they give nothing away, and the programs have many of the same
    private = {line for line in private if len(line) >= ORDINARY and line not in chapters}
    private = {line for line in private if not line.startswith(imports)}
    sheet = (root / "chapters/cheat_sheet.html").read_text()
    private = {line for line in private if line not in sheet}  # generic lines that every reader is shown
    assert len(private) > 80, "otherwise this looks for nothing"
    for path, text in released.items():
        # The programs use the same libraries: a short line may be in both.
        shortest = OWN if path.parts[0] in ("sim", "grader") else ORDINARY
        assert [line for line in private if len(line) >= shortest and line in text] == [], path
    # A variant of several files may leave one as the starter has it.
    several = [name for name in exercise_names(root) if find_exercise(name, root).files]
    starters = {path.read_bytes() for name in several for path in (root / "exercises" / name).rglob("*.py")}
    solved = [path for path in (root / "solutions").rglob("*.py") if path.read_bytes() not in starters]
    whole = {path.read_bytes() for path in solved}
    assert [path for path in student.rglob("*.py") if path.read_bytes() in whole] == []
    assert not {"solutions", "tests", ".git", ".venv", "runs", "__pycache__"} & {
        part for path in released for part in path.parts
    }


def test_exercises_chapters_and_programs_are_complete(student, root):
    for half in ("exercises", "chapters"):
        names = {path.name for path in (root / half).iterdir() if path.is_dir() and any(path.iterdir())}
        names |= {"cheat_sheet.html", "glossary.ipynb"} if half == "chapters" else set()
        assert {path.name for path in (student / half).iterdir()} == names
    graders = f"exercises/{NAME}/grading/exercise.toml"
    assert (student / ".grading" / graders).read_bytes() == (root / graders).read_bytes()
    assert not list((student / "exercises").rglob("grading"))
    excluded = tomllib.loads((student / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert "/.grading/exercises/*/README.md" in excluded["exclude"], "a wheel of the copy has each README once"
    for name in ("LICENSE", "constraints.txt", "pyproject.toml", ".gitignore", "grader/course.py", "sim/gz/command.py"):
        assert (student / name).is_file(), name
    # Whatever the build takes along must be there, or `pip install` fails.
    taken = re.findall(r'^"((?:sim|grader)/[\w./-]+)" = ', (student / "pyproject.toml").read_text(), re.MULTILINE)
    assert taken and [path for path in taken if not (student / path).exists()] == []


def test_its_readme_is_true(student):
    text = (student / "README.md").read_text()
    assert not re.search(r"@[A-Z]+@", text), "a mark was not filled in"
    assert "solution" not in text
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        assert re.match(r"[a-z]+:", target) or (student / target).exists(), target
    for path in re.findall(r"(?:exercises|chapters)/[\w./]+\.\w+", text):
        assert (student / path).is_file(), path
    commands = set(re.findall(r"\bcourse ([a-z]+)", text)) - {"on", "teaches"}  # words of a sentence
    assert {"doctor", "list", "grade", "show"} <= commands
    there = {path.stem for path in (student / "grader/commands").glob("*.py")}
    assert commands & {"new", "verify", "release"} == set() and {c for c in commands if c in text} <= there | {"needs"}
    assert not there & {"new", "release"}


@pytest.mark.proof
def test_the_course_works_in_it(student, course, clean, tmp_path):
    where = {"COURSE_ROOT": str(student), "PYTHONPATH": str(student / "public")}
    own = course(
        "list",
        prelude="import gz_course.grader as g, gz_course.sim.gz.sim as s; print(g.__file__, s.__file__)",
        **where,
    )
    assert own.stdout.count(str(student)) == 2, "it must be the copy's own programs that run"
    assert own.code == 0 and NAME in own.stdout and "04_lidar_listener" in own.stdout
    graded = course("grade", "03", "--out", tmp_path / "out", "--json", tmp_path / "report.json", **where)
    clean(graded)
    assert graded.code == 1, graded.output
    assert (graded.report["score"], graded.report["outcome"]) == (0, "graded")
    told = course("diff", "03", **where)
    assert told.code == 2 and "comes without solutions" in told.stderr


def give_away(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


@pytest.mark.parametrize(
    ("kind", "place"),
    [
        ("solution", f"exercises/{NAME}/{FILE}"),
        ("solution", f"exercises/{NAME}/notes/mine.txt"),
        ("accepted/two_timers", f"exercises/{NAME}/{FILE}"),
        ("solution", f"chapters/{NAME}/{NAME}.ipynb"),
    ],
)
def test_a_solution_that_lies_in_the_public_half_is_refused(small, tmp_path, kind, place):
    """Somebody has solved the exercise in place, or in the chapter's last cell."""
    folder = small / "solutions" / NAME
    text = (folder / FILE if kind == "solution" else folder / kind / FILE).read_text()
    text = "# mine\n" + text.replace("    ", "  ")  # indented otherwise: still the solution
    if place.endswith(".ipynb"):
        cell = {"cell_type": "code", "metadata": {}, "outputs": [], "source": text.splitlines(keepends=True)}
        text = json.dumps({"cells": [cell], "metadata": {}}, indent=1)
    give_away(small / place, text)
    with pytest.raises(ManifestError, match=rf"{place} holds all of the solution .*{FILE}"):
        release(small, tmp_path / "student")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["small"], "nothing is left of it"


def test_traces_of_work_are_left_out(small, tmp_path):
    text = (small / "solutions" / NAME / FILE).read_text()
    for trace in (".teleop.py.swp", "__pycache__/a.pyc", "runs/b.txt", "c.rrd", f"{FILE}~", ".ipynb_checkpoints/d.py"):
        give_away(small / "exercises" / NAME / trace, text)
    assert release(small, tmp_path / "student") == ([NAME], None)
    there = sorted(path.name for path in (tmp_path / "student/exercises" / NAME).rglob("*"))
    assert there == ["README.md", "bridge.yaml", FILE]


def test_a_link_to_a_solution_is_refused(small, tmp_path):
    (small / "exercises" / NAME / "more.py").symlink_to(small / "solutions" / NAME / "expect.toml")
    with pytest.raises(ManifestError, match=r"more\.py is a link out of"):
        release(small, tmp_path / "student")
    assert not (tmp_path / "student").exists()


def test_a_folder_that_is_not_empty_is_left_alone(course, tmp_path):
    give_away(tmp_path / "mine/work.txt", "work")
    outcome = course("release", tmp_path / "mine")
    assert (outcome.code, len(outcome.stderr.splitlines())) == (2, 1)
    assert "is not empty" in outcome.stderr
    assert [path.name for path in (tmp_path / "mine").iterdir()] == ["work.txt"]


def test_an_empty_folder_is_taken(small, course, tmp_path):
    (tmp_path / "empty").mkdir()
    outcome = course("release", tmp_path / "empty", COURSE_ROOT=str(small))
    assert outcome.code == 0, outcome.output
    assert NAME in outcome.stdout and (tmp_path / "empty/README.md").is_file()
    assert "04_lidar" not in (tmp_path / "empty/README.md").read_text()


def test_places_that_cannot_be_used(small, tmp_path, root):
    (tmp_path / "file").write_text("")
    for target, told in [
        (tmp_path / "file", "is a file"),
        (tmp_path / "file/below", "cannot be"),
        (small / "exercises/new", "lies inside"),
        (root / "grader/new", "lies inside"),
    ]:
        with pytest.raises(UsageError, match=told):
            release(small, target)
    assert not (root / "grader/new").exists() and not (small / "exercises/new").exists()


def test_nothing_to_release(tmp_path):
    Path(tmp_path / "course").mkdir()
    with pytest.raises(UsageError, match="no exercises"):
        release(tmp_path / "course", tmp_path / "student")
