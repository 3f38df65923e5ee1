"""The instructor's guide, followed literally: every file is written and every command run, in a course of its own."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
GUIDE = ROOT / "docs" / "instructors.md"
BLOCK = re.compile(
    r"(?:^Write `(?P<file>[^`]+)`:\n\n)?^```(?P<kind>\S+)(?P<fails> fails)?\n(?P<text>.*?)^```$", re.M | re.S
)
DEADLINE = 300  # [s] for one block of commands

pytestmark = [pytest.mark.proof, pytest.mark.timeout(2400)]


def steps():
    """The blocks of the guide: (file to write or None, whether the commands must fail, text)."""
    found = []
    for block in BLOCK.finditer(GUIDE.read_text()):
        if not block["file"] and block["kind"] == "toml":
            continue  # shows what a manifest or trials may hold
        assert block["file"] or block["kind"] == "sh", block["text"]
        found.append((block["file"], bool(block["fails"]), block["text"]))
    return found


@pytest.fixture(scope="module")
def followed(tmp_path_factory):
    """The course after all steps, and what each block of commands printed."""
    course = tmp_path_factory.mktemp("course")
    for half in ("exercises", "solutions"):
        shutil.copytree(ROOT / half / "03_teleop", course / half / "03_teleop")
    (course / "chapters").mkdir()
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("ROS_", "GZ_", "COURSE_"))}
    there = {
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        "COURSE_ROOT": str(course),
        "COLUMNS": "200",
    }
    printed = {}
    for file, fails, text in steps():
        if file:
            (course / file).parent.mkdir(parents=True, exist_ok=True)
            (course / file).write_text(text)
            continue
        done = subprocess.run(
            ["bash", "-euc", text], cwd=course, env=kept | there, capture_output=True, text=True, timeout=DEADLINE
        )
        # A class in which not everybody has full marks is graded all the same; a score below full marks is exit code 1.
        wanted = (3,) if fails else (0, 1) if "course score" in text else (0,)
        assert done.returncode in wanted, f"{text}\n{done.stdout}{done.stderr}"
        printed[text] = done.stdout + done.stderr
    return course, printed


def printed_by(followed, words):
    return " ".join(next(out for text, out in followed[1].items() if words in text).split())


def test_there_are_steps():
    assert sum(file is not None for file, _, _ in steps()) >= 7
    assert sum(file is None for file, _, _ in steps()) >= 9


def test_the_exercise_is_proven_and_listed(followed):
    assert "20_quarter_turn" in printed_by(followed, "course list")
    assert "A quarter turn" in printed_by(followed, "course list")


def test_an_author_is_told_that_there_is_no_such_world(followed):
    told = printed_by(followed, "course grade 20_quarter_turn\n")
    assert "exercise.toml" in told and "empty_with_robot.sdf" in told


def test_the_class_has_a_gradebook_with_the_scores_the_guide_leads_to(followed):
    book = (followed[0] / "grades" / "gradebook.csv").read_text(encoding="utf-8-sig")
    rows = {line.split(",")[0]: line for line in book.splitlines()}
    assert ",100,100,graded," in rows["ada"] and ",75,100,graded," in rows["grace"]
    assert "quarter 0 -> 25 (by Ada: half of the turn)" in rows["grace"]
    assert ",,100,excused," in rows["linus"] and "excused (ill)" in rows["linus"]


def test_the_students_copy_holds_the_exercise_and_no_solution(followed):
    copy = followed[0] / "students"
    assert (copy / "exercises/20_quarter_turn/README.md").is_file()
    assert not (copy / "solutions").exists() and not list(copy.rglob("trials.toml"))
