"""The student's folder of a clone: what it shows, what is taken along, and what an update leaves alone."""

import shutil
import subprocess

import pytest

from gz_course.grader.course_folder import in_clone, layout
from gz_course.grader.course_folder.in_clone import refresh
from gz_course.grader.course_folder.layout import Changes
from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.pristine import put_back

GIT = ["git", "-c", "user.name=x", "-c", "user.email=x@y", "-c", "init.defaultBranch=main"]
STARTER = "exercises/03_teleop/teleop_node.py"


@pytest.fixture
def clone(root, tmp_path, monkeypatch):
    """A small course in git, whose code is here."""
    clone = tmp_path / "clone"
    for part in ("exercises", "chapters", "solutions"):
        shutil.copytree(root / part / "03_teleop", clone / part / "03_teleop")
    for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "handed out"]):
        subprocess.run([*GIT, *words], cwd=clone, check=True)
    for module in (layout, in_clone):
        monkeypatch.setattr(module, "material", lambda: clone)
    return clone


@pytest.fixture
def commit(clone):
    """Change a file of the course, as a newer version does."""

    def write(name, text):
        (clone / name).write_text(text)
        subprocess.run([*GIT, "commit", "-qam", "newer"], cwd=clone, check=True)

    return write


def test_it_shows_chapters_and_exercises_only(clone):
    mine = clone / "my_course"
    assert refresh(mine) == Changes()
    assert sorted(path.name for path in mine.iterdir() if path.name[0] != ".") == ["chapters", "exercises"]
    assert not list(mine.rglob("grading")) and not list(mine.rglob("expect.toml"))
    assert find_exercise("03", mine).starter == mine / STARTER


def test_work_in_the_clones_own_exercises_is_taken_along(clone):
    starter = (clone / STARTER).read_bytes()
    (clone / STARTER).write_text("my work")
    mine = clone / "my_course"
    refresh(mine)
    assert (mine / STARTER).read_text() == "my work"
    assert refresh(mine) == Changes()
    put_back(find_exercise("03", mine), mine / "runs")
    assert (mine / STARTER).read_bytes() == starter


def test_an_update_brings_what_is_newer_and_keeps_own_work(clone, commit):
    mine = clone / "my_course"
    refresh(mine)
    (mine / STARTER).write_text("my work")
    commit(STARTER, "newer starter")
    commit("exercises/03_teleop/README.md", "# Drive\n\nDrive.\n")
    changes = refresh(mine)
    assert (mine / STARTER).read_text() == "my work"
    assert (mine / STARTER).with_name("teleop_node.new.py").read_text() == "newer starter"
    assert changes.lines == [
        "replaced: exercises/03_teleop/README.md",
        f"kept: {STARTER} is yours; the newer one is exercises/03_teleop/teleop_node.new.py",
    ]
    assert not (mine / "README.md").exists()


def test_a_folder_of_somebody_else_is_left_alone(clone):
    (clone / "my_course").mkdir()
    (clone / "my_course/notes.txt").write_text("mine")
    with pytest.raises(UsageError, match="was not made by `make chapters`"):
        refresh(clone / "my_course")
    assert [path.name for path in (clone / "my_course").iterdir()] == ["notes.txt"]
