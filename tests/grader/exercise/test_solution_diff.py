"""`course diff` shows what changes between starter and solution, and nothing else."""

import shutil

import pytest

from gz_course.grader.commands.diff import style_of
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.solution_diff import solution_diff

NAME, FILE = "03_teleop", "teleop_node.py"


@pytest.fixture
def copy(tmp_path, root):
    for half in ("exercises", "solutions"):
        shutil.copytree(root / half / NAME, tmp_path / half / NAME)
    return tmp_path


def diff(copy):
    return list(solution_diff(find_exercise(NAME, copy)))


def test_the_change_of_a_real_exercise(root, course):
    outcome = course("diff", "03")
    lines = outcome.stdout.splitlines()
    assert outcome.code == 0 and outcome.stderr == ""
    assert lines[:2] == [f"--- exercises/{NAME}/{FILE}", f"+++ solutions/{NAME}/{FILE}"]
    before = (root / "exercises" / NAME / FILE).read_text().splitlines()
    after = (root / "solutions" / NAME / FILE).read_text().splitlines()
    added = [line[1:] for line in lines[2:] if line.startswith("+")]
    removed = [line[1:] for line in lines[2:] if line.startswith("-")]
    assert added and removed
    assert sorted([*before, *added]) == sorted([*after, *removed])


def test_it_is_coloured_in_a_terminal_only(course):
    plain, coloured = course("diff", "03"), course("diff", "03", FORCE_COLOR="1", TERM="xterm-256color")
    assert "\x1b[" not in plain.stdout
    assert "\x1b[32m+" in coloured.stdout and "\x1b[31m-" in coloured.stdout
    assert [style_of(line) for line in ("+++ a", "--- a", "@@ 1", "+x", "-x", " x", "")] == [
        "bold", "bold", "cyan", "green", "red", "", "",
    ]  # fmt: skip


def test_files_only_the_solution_has_and_files_that_are_no_text(copy):
    (copy / "solutions" / NAME / "extra.launch.py").write_text("new\n")
    (copy / "solutions" / NAME / "picture.png").write_bytes(b"\x89PNG\xff\xfe")
    lines = diff(copy)
    at = lines.index(f"+++ solutions/{NAME}/extra.launch.py")
    assert lines[at - 1] == "--- /dev/null" and lines[at + 2] == "+new"
    assert "+(6 bytes that are no text)" in lines
    assert not any("expect.toml" in line for line in lines)


def test_what_is_not_shown_in_a_terminal_is_what_patch_takes(copy, course):
    """Tabs and ends of lines as they are, whatever the width."""
    path = copy / "solutions" / NAME / FILE
    path.write_text(path.read_text() + "x = 1\t# " + "long " * 60 + "end\n")
    outcome = course("diff", "03", COURSE_ROOT=str(copy))
    assert "+x = 1\t# " + "long " * 60 + "end" in outcome.stdout.splitlines()


def test_a_starter_that_is_the_solution(copy, course):
    shutil.copy(copy / "solutions" / NAME / FILE, copy / "exercises" / NAME / FILE)
    outcome = course("diff", "03", COURSE_ROOT=str(copy))
    assert (outcome.code, outcome.stdout.count("\n")) == (0, 1)
    assert "nothing changes" in outcome.stdout


def test_a_copy_without_solutions_says_so_in_one_sentence(copy, course):
    shutil.rmtree(copy / "solutions")
    outcome = course("diff", "03", COURSE_ROOT=str(copy))
    assert (outcome.code, outcome.stdout, len(outcome.stderr.splitlines())) == (2, "", 1)
    assert "comes without solutions" in outcome.stderr


def test_an_unknown_exercise(course):
    outcome = course("diff", "03_telepo")
    assert outcome.code == 2 and "did you mean '03_teleop'?" in outcome.words
