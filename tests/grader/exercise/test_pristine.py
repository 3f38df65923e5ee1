"""`course reset`: the starter comes back from git or from the students' copy, and no work is lost."""

import shutil
import subprocess

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.pristine import STARTERS, put_back

GIT = ["git", "-c", "user.name=x", "-c", "user.email=x@y", "-c", "init.defaultBranch=main"]


@pytest.fixture
def copied(tmp_path, root):
    shutil.copytree(root / "exercises/03_teleop", tmp_path / "exercises/03_teleop")
    return find_exercise("03", tmp_path)


def test_git_knows_the_starter_of_the_branch_that_is_followed(copied, tmp_path):
    starter = copied.starter.read_bytes()
    for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "handed out"], ["branch", "course"],
                  ["branch", "-q", "--set-upstream-to=course"]):  # fmt: skip
        subprocess.run([*GIT, *words], cwd=tmp_path, check=True)
    copied.starter.write_text("mine")
    subprocess.run([*GIT, "commit", "-qam", "my own work"], cwd=tmp_path, check=True)
    assert put_back(copied, tmp_path / "runs") == tmp_path / "runs/kept-1"
    assert copied.starter.read_bytes() == starter
    assert put_back(copied, tmp_path / "runs") is None, "it is the starter already"
    copied.starter.write_text("second")
    assert (put_back(copied, tmp_path / "runs") / "teleop_node.py").read_text() == "second"
    assert (tmp_path / "runs/kept-1/teleop_node.py").read_text() == "mine"


def test_the_students_copy_holds_the_starters(copied, tmp_path):
    (tmp_path / STARTERS / "03_teleop").mkdir(parents=True)
    (tmp_path / STARTERS / "03_teleop/teleop_node.py").write_text("as handed out")
    copied.starter.unlink()
    assert put_back(copied, tmp_path / "runs") is None
    assert copied.starter.read_text() == "as handed out"


def test_without_either_it_says_so_and_touches_nothing(copied, tmp_path):
    copied.starter.write_text("mine")
    with pytest.raises(UsageError, match=r"neither \.starters/ nor git's history"):
        put_back(copied, tmp_path / "runs")
    assert copied.starter.read_text() == "mine"
